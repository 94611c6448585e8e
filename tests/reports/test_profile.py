"""The figure of success and clean success of every method in every suite."""

import re
from collections.abc import Callable
from dataclasses import replace

from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.reports.comparison import Compared
from codriving.reports.profile import profile_figure
from codriving.reports.results import CellResults

Make = Callable[..., EpisodeRecord]


def row(make: Make, method: str, won: int, clean: bool) -> Compared:
    records = [make(k, Ending.SUCCESS if k < won else Ending.TIMEOUT, method=method, variant="") for k in range(4)]
    if clean:
        records = [
            replace(r, scores={name: replace(s, clean=bool(s.success)) for name, s in r.scores.items()})
            for r in records
        ]
    return Compared("intersection", method, cell=CellResults(records))


def test_a_panel_a_suite_and_a_row_a_method_the_same_to_the_byte(make: Make) -> None:
    suites = [
        ("standoff", [row(make, "fcfs", 3, True), Compared("intersection", "madqn", "not there yet")]),
        ("crowd", [row(make, "fcfs", 1, True), row(make, "mine", 0, False)]),
    ]
    found = profile_figure(suites, "standard")
    assert set(found) == {"profile.png", "profile.svg"}
    assert profile_figure(suites, "standard") == found
    said = set(re.findall(r"<!-- (.*?) -->", found["profile.svg"].decode()))
    assert {"standoff", "crowd", "fcfs", "mine", "success", "clean success"} <= said
    assert "madqn" not in said, "what was not driven has no row"


def test_other_rates_make_another_figure(make: Make) -> None:
    one, two = (profile_figure([("a", [row(make, "fcfs", won, True)])], "standard")["profile.svg"] for won in (3, 2))
    assert one != two
