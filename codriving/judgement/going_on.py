"""Whether a human driver lets a CAV pass that goes on: a copy of the world is driven on, and seen."""

from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

from codriving.datatypes import Action, Role, Simulator, Situation, WorldState
from codriving.geometry import progress
from codriving.judgement.contests import Contest
from codriving.judgement.hindsight import entries, let_pass

LONGEST = 12.0  # How long the CAV goes on [s]
CLEARS = 2.0  # How long after it has come to the zone a collision says that it was not let pass [s]
ROOM = (4.0, 1.5)  # Distance [m] and time [s] to the vehicle ahead below which it does as the method does


class DecidedStep(Protocol):
    """What a method does for all CAVs, and the situations in which it decided; none of a CAV while it thinks."""

    @property
    def time(self) -> float:
        """When [s]."""

    @property
    def actions(self) -> Mapping[str, Action]:
        """The action of each CAV on the road."""

    @property
    def situations(self) -> Sequence[Situation]:
        """What was decided about."""


def lets_pass(
    copied: Simulator, act: Callable[[WorldState], DecidedStep], deliberation: DecidedStep, contest: Contest
) -> bool | None:
    """Let the CAV of a pair go on, and see who of both comes first in their next zone.

    Args:
        copied: A copy of the world, which is driven on.
        act: What a copy of the method does for all CAVs from the next step on.
        deliberation: What it does now.

    Returns:
        None if neither comes there.
    """
    began, first, passed = deliberation.time, None, 0.0
    while True:
        actions = deliberation.actions
        scene = next((s.scene for s in deliberation.situations if s.scene.ego.id == contest.cav), None)
        ahead = scene.next_in(Role.LEADING) if scene is not None else None
        near = scene is not None and ahead is not None and (ahead.gap or 0.0) <= ROOM[0] + ROOM[1] * scene.ego.speed
        if contest.cav in actions and not near:
            actions = {**actions, contest.cav: Action.FASTER}
        world = copied.step(actions)
        if first is None:
            times, passed = entered(copied, contest), world.time
            # Where there is no zone before them any more, they do not meet.
            first = let_pass(times, began) if any(min(both) > began for both in times) else True
        seen = first is False or contest.cav not in actions or (first and world.time > passed + CLEARS)
        if seen or copied.outcome is not None or world.time >= began + LONGEST:
            break
        deliberation = act(world)
    outcome = copied.outcome
    if outcome is not None and {contest.cav, contest.human} <= set(outcome.failed):
        return False  # It did not let it pass
    return first


def entered(driven: Simulator, contest: Contest) -> list[tuple[float, float]]:
    """Return when the CAV and the driver of a pair have entered each zone of both so far; inf if not yet [s]."""
    trajectory, road_map = driven.trajectory(), driven.road_map
    tracks = {track.id: track for track in trajectory.tracks if track.id in (contest.cav, contest.human)}
    places = {name: progress(road_map.paths[t.route], t.x, t.y, t.heading) for name, t in tracks.items()}
    return entries(tracks[contest.cav], tracks[contest.human], places, road_map, trajectory.step)
