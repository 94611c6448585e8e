"""Figures that stand in a page: no style, no id twice, the page's own colour for words, the same bytes each time."""

import re
from xml.etree import ElementTree

import matplotlib
import pytest

from codriving.datatypes.record import Ending, EpisodeRecord, Outcome, Pet, Score, TravelScore
from codriving.pages.figures import figures
from codriving.reports.results import CellResults


def cell(*pets: float, ending: Ending = Ending.SUCCESS) -> CellResults:
    score = Score(
        ending is Ending.SUCCESS,
        tuple(Pet("CAV1", "CAV2", "crossing", pet) for pet in pets),
        (TravelScore("CAV1", 6.5, 20.0, 2.0),),
    )
    record = EpisodeRecord(
        "intersection", "fcfs", "", "none", 3, Outcome(ending, 20.0, {}), {"standard": score}, (), 40, {}
    )
    return CellResults([record], papers_setting=False, as_in_paper=False)


@pytest.fixture(scope="module")
def drawn() -> list[tuple[str, str]]:
    return figures([("one <b>", cell(1.0, 4.0)), ("other", cell(2.0)), ("hit", cell(ending=Ending.COLLISION))])


def test_one_for_endings_pets_trade_off_and_performance(drawn: list[tuple[str, str]]) -> None:
    assert [name for name, _ in drawn] == [
        "How episodes ended",
        "PETs of all pairs",
        "Velocity against severe PETs; lines of equal velocity times the share of other PETs",
        "Seeds driven within a factor of the fastest row, by travel time",
    ]
    endings, pets, trade, performance = (set(ElementTree.fromstring(svg).itertext()) for _, svg in drawn)
    assert {"success", "collision", "one <b>", "other", "hit"} <= endings
    assert {"severe below 1.5 s", "one <b>", "other"} <= pets
    assert "hit" not in pets
    assert {"one <b>", "other"} <= trade
    assert {"one <b>", "other", "hit"} <= performance


def test_they_suit_a_strict_page(drawn: list[tuple[str, str]]) -> None:
    ids = [name for _, svg in drawn for name in re.findall(r' id="([^"]+)"', svg)]
    assert len(ids) == len(set(ids)) > 0
    for _, svg in drawn:
        assert " style=" not in svg
        assert "<style" not in svg
        assert "currentColor" in svg
        assert "#010203" not in svg
        for name in re.findall(r'(?:href="#|url\(#)([^")]+)', svg):
            assert name in ids


def test_the_same_bytes_each_time(drawn: list[tuple[str, str]]) -> None:
    again = figures([("one <b>", cell(1.0, 4.0)), ("other", cell(2.0)), ("hit", cell(ending=Ending.COLLISION))])
    assert again == drawn


def test_one_row_has_no_trade_off() -> None:
    assert [name for name, _ in figures([("hit", cell(ending=Ending.COLLISION))])] == ["How episodes ended"]


@pytest.mark.parametrize("name", ["$x^{$", r"a \$1$2$", "_first", "\u6d4b\u8bd5 \u0641\u0627\u0631"])
def test_a_name_is_written_as_it_is(name: str) -> None:
    found = figures([(name, cell(1.0, 4.0)), ("other", cell(2.0))])
    assert len(found) == 4
    for _, svg in found:
        assert name in [text.strip() for text in ElementTree.fromstring(svg).itertext()]


@pytest.mark.parametrize(("letter", "kept"), [("x", (21, 12)), ("\u6d4b", (7, 4))])
def test_a_long_name_leaves_room(letter: str, kept: tuple[int, int]) -> None:
    found = figures([(f"first {letter * 200} end", cell(1.0, 4.0)), ("other", cell(2.0))])
    assert len(found) >= 3
    for _, svg in found:
        words = "".join(ElementTree.fromstring(svg).itertext())
        assert f"first {letter * kept[0]}...{letter * kept[1]} end" in words


def test_what_a_user_has_set_for_matplotlib_changes_nothing(drawn: list[tuple[str, str]]) -> None:
    with matplotlib.rc_context({"font.size": 20, "axes.grid": True, "lines.linewidth": 5}):
        again = figures([("one <b>", cell(1.0, 4.0)), ("other", cell(2.0)), ("hit", cell(ending=Ending.COLLISION))])
    assert again == drawn
