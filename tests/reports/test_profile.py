"""The figure of success and clean success of every method in every suite."""

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import pytest
from matplotlib.figure import Figure

from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.reports.comparison import Compared
from codriving.reports.figures import saved
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


def drawn(monkeypatch: pytest.MonkeyPatch, suites: list[tuple[str, list[Compared]]]) -> Figure:
    """Draw a profile and keep the figure."""
    made: list[Figure] = []

    def kept(figure: Figure, *others: Any) -> Mapping[str, bytes]:
        made.append(figure)
        return saved(figure, *others)

    monkeypatch.setattr("codriving.reports.profile.saved", kept)
    profile_figure(suites, "standard")
    return made[0]


def test_settings_of_a_suite_have_panels_of_their_own(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    one = row(make, "fcfs", 3, True)
    loads = [replace(one, swept={"suite": "crowd", "scenario.cavs": n, "method_choice": "fcfs"}) for n in ("4", "8")]
    roads = [replace(one, scenario=name, swept={"suite": "paper"}) for name in ("merge", "highway")]
    figure = drawn(monkeypatch, [("blind", [one]), ("crowd", loads), ("paper", roads)])
    panels = [axis.get_title() for axis in figure.axes]
    assert panels == ["blind", "crowd\nscenario.cavs=4", "crowd\nscenario.cavs=8", "paper\nmerge", "paper\nhighway"]


def test_rates_are_of_completed_episodes_and_stand_in_the_row_of_their_method(
    make: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    endings = (Ending.SUCCESS, Ending.SUCCESS, Ending.TIMEOUT, Ending.TIMEOUT, Ending.ERROR)
    half = Compared("intersection", "mine", cell=CellResults([make(k, e, variant="") for k, e in enumerate(endings)]))
    figure = drawn(monkeypatch, [("standoff", [row(make, "fcfs", 3, False), half]), ("crowd", [half])])
    for axis, places in zip(figure.axes, ([(75.0, 0), (50.0, 1)], [(50.0, 1)]), strict=True):
        marks = [line.get_xydata()[0] for line in axis.get_lines() if line.get_label() == "success"]
        assert [(x, round(y)) for x, y in marks] == places


@pytest.mark.parametrize("suites", [2, 6])
def test_nothing_lies_under_the_legend_and_nothing_is_cut(
    make: Make, monkeypatch: pytest.MonkeyPatch, suites: int
) -> None:
    rows = [row(make, name, 3, True) for name in ("fcfs", "random_action control")]
    figure = drawn(monkeypatch, [(f"suite {k}", rows) for k in range(suites)])
    legend = figure.legends[0].get_window_extent()
    texts = [text.get_window_extent() for text in figure.texts if text.get_text()]
    boxes = [*texts, *(axis.get_tightbbox() for axis in figure.axes)]
    assert not any(legend.overlaps(box) for box in boxes)
    width, height = figure.bbox.size + 1
    assert all(b.x0 >= -1 and b.y0 >= -1 and b.x1 <= width and b.y1 <= height for b in (legend, *boxes))


def test_a_name_with_dollar_signs_is_no_formula(make: Make) -> None:
    files = profile_figure([("$x_{$", [row(make, "fcfs", 4, True)])], "standard")
    assert "<!-- $x_{$ -->" in files["profile.svg"].decode()
