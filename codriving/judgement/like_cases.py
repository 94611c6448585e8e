"""What drivers did who were met before, counted by cases that are alike."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from codriving.datatypes import MetDriver
from codriving.geometry import RoadMap
from codriving.judgement.contests import Contest
from codriving.reasoning import Moment

# What parts cases: who would be at the zone first, as near as this is no difference [s]; who stands waits [s].
CLEARLY, STANDS = 1.0, 1.0

Case = tuple[bool | int, ...]


@dataclass(slots=True)
class Count:
    """How many drivers let the CAV pass, of how many."""

    yielded: int = 0
    all: int = 0

    @property
    def share(self) -> float:
        """The share of those who did, by Laplace's rule: with one more who did, and one more who did not."""
        return (self.yielded + 1) / (self.all + 2)

    @property
    def words(self) -> str:
        """The same in words."""
        return f"{self.yielded} of {self.all} drivers met in like cases let the CAV pass"


class LikeCases:
    """Counts of drivers in like cases; where few are known, of all whom the rules of the road hold back, or do not."""

    def __init__(self, encounters: Iterable[MetDriver], fewest: int) -> None:
        self.fewest, self._counts = fewest, defaultdict[Case, Count](Count)
        for met in encounters:
            for case in _cases(met.numbers, met.relied):
                self._counts[case].yielded += met.yielded
                self._counts[case].all += 1

    def of(self, contest: Contest) -> Count | None:
        """Count the drivers who were in a like case; None if too few were met to tell."""
        counts = (self._counts.get(case, Count()) for case in _cases(contest.numbers, bool(contest.rule)))
        return next((count for count in counts if count.all >= self.fewest), None)


def _cases(numbers: Mapping[str, float], relied: bool) -> Iterator[Case]:
    """Give the cases that one is counted in, the narrowest first."""
    ahead = (numbers["time_ahead"] > CLEARLY) - (numbers["time_ahead"] < -CLEARLY)
    yield relied, int(numbers["priority"]), ahead, numbers["human_standing"] >= STANDS
    yield (relied,)


class CaseObserver:
    """Sees of pairs that were judged who was first in their zone, as the CAV itself can see it.

    Of a pair one case of a kind is kept, so that a driver who was judged at many steps counts once in each.
    """

    def __init__(self, road_map: RoadMap) -> None:
        self._road_map, self._step = road_map, 0
        self._open: dict[tuple[str, str, str, int], dict[Case, tuple[Contest, int]]] = {}
        self.found: list[MetDriver] = []

    def note(self, asked: Iterable[Contest]) -> None:
        """Keep what is judged now."""
        for contest in asked:
            kinds = self._open.setdefault((contest.cav, contest.human, contest.way, contest.conflict.zone), {})
            kinds.setdefault(next(_cases(contest.numbers, bool(contest.rule))), (contest, self._step))

    def watch(self, moment: Moment) -> None:
        """See who has entered a zone since, and drop pairs that the CAV does not see any more."""
        self._step += 1
        for key in list(self._open):
            cav, human, way, number = key
            scene, driver = moment.scenes.get(cav), moment.vehicles.get(cav, {}).get(human)
            place = dict(driver.routes).get(way) if driver is not None else None
            if scene is None or place is None:
                del self._open[key]
                continue
            zone = self._road_map.zones(scene.intent.route, way)[number]
            mine, its = scene.place > zone.entry_i, place > zone.entry_j
            if mine or its:
                kinds = self._open.pop(key).values()
                if mine != its:
                    self.found += [
                        MetDriver(cav, human, step, contest.numbers, bool(contest.rule), mine)
                        for contest, step in kinds
                    ]
