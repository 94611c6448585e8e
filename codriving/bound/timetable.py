"""When CAVs pass the places that matter, for given orders: the exact answer where it is known who goes first."""

from collections.abc import Mapping, Sequence

import numpy as np

from codriving.bound.meetings import MeetingPlace
from codriving.bound.passing import Passing
from codriving.geometry import FloatArray

FARTHEST = 3  # Places in an order by which a CAV is moved forward at once, in search of a better one


class Timetable:
    """The places of each CAV that matter to some meeting, and the times at which they can be passed."""

    def __init__(self, cavs: Sequence[Passing], meetings: Sequence[MeetingPlace], gap: float, step: float) -> None:
        self.cavs, self.meetings, self.gap, self.step = cavs, meetings, gap, step
        wanted = [{cav.route.goal} for cav in cavs]
        for meeting in meetings:
            for first, second in ((meeting.i, meeting.j), (meeting.j, meeting.i)):
                for b, a in meeting.rows(first):
                    wanted[second].add(b)
                    wanted[first].add(a)
        self.places = [np.array(sorted(places)) for places in wanted]
        self.least = [cav.least_time(places) for cav, places in zip(cavs, self.places, strict=True)]
        # Who is late at one place is late at all that follow.
        self.earliest = [
            _onwards(cav.earliest(places), least)
            for cav, places, least in zip(cavs, self.places, self.least, strict=True)
        ]
        self.offsets = np.cumsum([0, *(len(places) for places in self.places)]).tolist()
        self._index = [{float(p): k for k, p in enumerate(places)} for places in self.places]
        self._before: list[set[int]] = [set() for _ in cavs]
        self._rows: dict[tuple[int, int], list[tuple[list[int], list[int]]]] = {}
        for meeting in meetings:
            for first, second in ((meeting.i, meeting.j), (meeting.j, meeting.i)):
                if meeting.first == first:
                    self._before[second].add(first)
                self._rows.setdefault((first, second), []).append(self._numbers(meeting, first, second))

    def column(self, cav: int, place: float) -> int:
        """Return the number of a place among those of all CAVs."""
        return int(self.offsets[cav]) + self._index[cav][place]

    def one_after_another(self) -> list[FloatArray] | None:
        """Return good times if CAVs pass everything in one order of vehicles; None if their starts allow no order."""
        order = self._first_order()
        if order is None:
            return None
        best = self.in_order(order)
        improved = True
        while improved:
            improved = False
            for k in range(1, len(order)):
                for to in range(k - 1, max(k - FARTHEST - 1, -1), -1):
                    if order[to] in self._before[order[k]]:
                        break
                    tried = [*order[:to], order[k], *order[to:k], *order[k + 1 :]]
                    times = self.in_order(tried)
                    if total(times) < total(best) - 1e-9:
                        order, best, improved = tried, times, True
                        break
        return best

    def in_order(self, order: Sequence[int]) -> list[FloatArray]:
        """Return when all pass their places if they go in one order everywhere."""
        times = [early.copy() for early in self.earliest]
        for k, cav in enumerate(order):
            own = times[cav]
            for first in order[:k]:
                for here, there in self._rows.get((first, cav), ()):
                    own[there] = np.maximum(own[there], times[first][here] + self.gap)
            times[cav] = _onwards(own, self.least[cav])
        return times

    def with_firsts(self, firsts: Mapping[int, int]) -> list[FloatArray]:
        """Return when all pass their places if it is known who goes first at each meeting, by its number."""
        times = [early.copy() for early in self.earliest]
        changed = True
        rounds = 0
        while changed and rounds <= 2 * len(self.meetings) + 2:
            changed, rounds = False, rounds + 1
            for number, meeting in enumerate(self.meetings):
                first = firsts[number]
                second = meeting.j if first == meeting.i else meeting.i
                here, there = self._numbers(meeting, first, second)
                later = times[first][here] + self.gap
                if np.any(later > times[second][there] + 1e-9):
                    times[second][there] = np.maximum(times[second][there], later)
                    times[second] = _onwards(times[second], self.least[second])
                    changed = True
        return times

    def _numbers(self, meeting: MeetingPlace, first: int, second: int) -> tuple[list[int], list[int]]:
        rows = meeting.rows(first)
        return [self._index[first][a] for _, a in rows], [self._index[second][b] for b, _ in rows]

    def _first_order(self) -> list[int] | None:
        order: list[int] = []
        while len(order) < len(self.cavs):
            ready = [k for k in range(len(self.cavs)) if k not in order and self._before[k] <= set(order)]
            if not ready:
                return None
            order.append(min(ready, key=lambda k: float(self.earliest[k][-1])))
        return order


def total(times: Sequence[FloatArray]) -> float:
    """Return the sum of the last times [s]."""
    return sum(float(own[-1]) for own in times)


def _onwards(times: FloatArray, least: FloatArray) -> FloatArray:
    return np.asarray(least + np.maximum.accumulate(times - least))
