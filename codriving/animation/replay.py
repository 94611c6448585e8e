"""An episode as it is kept, at any moment: positions between two steps are interpolated, decisions are not."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from codriving.animation.deliberated import Deliberated, action_named, deliberated
from codriving.animation.moment import Body, Moment, Thought
from codriving.datatypes.outcome import Outcome
from codriving.datatypes.trajectory import Track, Trajectory
from codriving.datatypes.vehicle import Kind
from codriving.geometry.road_map import RoadMap


class Replay:
    """The moments of one episode.

    Args:
        decisions: Lines of ``decisions.jsonl``, by time; what another method wrote differently is not shown.

    Attributes:
        duration: Time from the first row to the last [s].
    """

    def __init__(
        self, road_map: RoadMap, trajectory: Trajectory, decisions: Sequence[Mapping[str, Any]], outcome: Outcome
    ) -> None:
        self._trajectory, self._outcome = trajectory, outcome
        self._headings = {track.id: np.unwrap(track.heading) for track in trajectory.tracks}
        self._decided = [deliberated(line, road_map) for line in decisions]
        self._times = np.array([d.time for d in self._decided])
        self.duration = max((t.first_step + len(t.x) - 1) * trajectory.step for t in trajectory.tracks)

    def at(self, time: float) -> Moment:
        """Return what there was at a moment.

        Args:
            time: Simulated time [s]; after the end it is as at the end.
        """
        time = min(max(time, 0.0), self.duration)
        decided = self._decision(time)
        routes = decided.routes
        bodies = []
        thoughts = dict(decided.thoughts)
        for track in self._trajectory.tracks:
            row = time / self._trajectory.step - track.first_step
            if not -1e-6 <= row <= len(track.x) - 1 + 1e-6:
                continue
            bodies.append(self._body(track, row, routes))
            if track.kind is Kind.CAV and track.id not in thoughts:
                action = action_named(track.action[min(int(row + 1), len(track.x) - 1)])
                thoughts[track.id] = Thought(action)
        over = time >= self.duration - 1e-6
        return Moment(
            time=time,
            bodies=tuple(bodies),
            thoughts=thoughts,
            meetings=decided.meetings,
            order=decided.order,
            order_title=decided.order_title,
            arrived={name: at for name, at in self._outcome.arrivals.items() if at <= time + 1e-6},
            outcome=self._outcome if over else None,
        )

    def _decision(self, time: float) -> Deliberated:
        k = int(np.searchsorted(self._times, time + 1e-6, side="right")) - 1
        return self._decided[k] if k >= 0 else Deliberated(time)

    def _body(self, track: Track, row: float, routes: Mapping[str, str]) -> Body:
        k = min(max(int(row), 0), max(len(track.x) - 2, 0))
        share, after = min(max(row - k, 0.0), 1.0), min(k + 1, len(track.x) - 1)

        def between(values: np.ndarray) -> float:
            return float(values[k] + share * (values[after] - values[k]))

        route = routes.get(track.id, track.route) if track.kind is Kind.CAV else None
        return Body(
            track.id,
            track.kind,
            between(track.x),
            between(track.y),
            between(self._headings[track.id]),
            between(track.speed),
            route,
            track.length,
            track.width,
        )
