"""Figures of any run: what is drawn, where, that nothing overlaps or is cut, and the same bytes each time."""

import re
from collections.abc import Callable, Mapping
from typing import Any

import matplotlib
import pytest
from matplotlib.figure import Figure

from codriving.datatypes.record import Ending, EpisodeRecord, Outcome, Pet, Score, TravelScore
from codriving.reports import figures_of_runs as drawing
from codriving.reports.figures import saved
from codriving.reports.figures_of_runs import DrawnRow, rate_figure, run_figures
from codriving.reports.results import CellResults

GOOD, HIT = Ending.SUCCESS, Ending.COLLISION
Drawn = Callable[..., dict[str, Figure]]


def episode(seed: int, ending: Ending, pets: tuple[float, ...], time: float, speed: float) -> EpisodeRecord:
    score = Score(
        ending is GOOD,
        tuple(Pet("CAV1", "CAV2", "crossing", pet) for pet in pets),
        (TravelScore("CAV1", speed, time, 2.0),),
        clean=ending is GOOD and min(pets) >= 1.5,
    )
    return EpisodeRecord("merge", "m", "", "none", seed, Outcome(ending, time, {}), {"standard": score}, (), 40, {})


def row(name: str, *times: float, block: str = "merge", pet: float = 2.0, speed: float = 7.0) -> DrawnRow:
    """Episodes with such travel times; one of 0 s ended in a collision."""
    made = [episode(k, GOOD if time else HIT, (pet, 4.0), time, speed) for k, time in enumerate(times)]
    return DrawnRow(name, block, CellResults(made))


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> Drawn:
    """What draws and keeps the figures, by name."""

    def draw(rows: list[DrawnRow], *only: str) -> dict[str, Figure]:
        made: dict[str, Figure] = {}

        def kept(figure: Figure, handles: Any, heading: str, name: str) -> Mapping[str, bytes]:
            made[name] = figure
            return saved(figure, handles, heading, name)

        monkeypatch.setattr(drawing, "saved", kept)
        # Laid out as for a file, but not written.
        monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: figure.draw_without_rendering())
        run_figures(rows, "standard", only)
        return made

    return draw


TWO = [row("fast", 10.0, 12.0, 0.0, 10.0, pet=1.0, speed=8.0), row("slow", 20.0, 12.0, 18.0, 0.0, speed=6.0)]


def test_five_figures_as_png_and_svg_the_same_whatever_a_user_has_set() -> None:
    found = run_figures(TWO, "standard")
    names = ["endings", "rates", "pets", "trade-off", "performance"]
    assert list(found) == [f"{name}.{kind}" for name in names for kind in ("png", "svg")]
    assert all(content.startswith(b"\x89PNG") for name, content in found.items() if name.endswith("png"))
    with matplotlib.rc_context({"font.size": 20, "axes.grid": False, "lines.linewidth": 5}):
        for name, content in run_figures(TWO, "standard", ["rates", "trade-off"]).items():
            assert content == found[name]
    said = re.findall(r"<!-- (.*?) -->", found["pets.svg"].decode())
    assert {"fast", "slow", "severe below 1.5 s", "PET [s]", "merge"} <= set(said)
    assert set(rate_figure(TWO, "ablation", "standard")) == {"ablation.png", "ablation.svg"}


def test_lines_and_bars_stand_where_the_numbers_are(drawn: Drawn) -> None:
    made = drawn(TWO)
    pets = {line.get_label(): line.get_xydata() for line in made["pets"].axes[0].get_lines()}
    assert [list(point) for point in pets["fast"]][:2] == [[0.0, 0.0], [1.0, 12.5]]
    # Half of the PETs of the fast row are 1.0 s, so that half of them are severe; none of the slow one.
    trade = made["trade-off"].axes[0]
    places = {line.get_label(): [float(v) for v in line.get_xydata()[0]] for line in trade.get_lines()}
    assert places == {"fast": [8.0, 50.0], "slow": [6.0, 0.0]}
    assert [text.get_text() for text in trade.texts], "iso-lines say their value"
    # Seed 0: 10 and 20 s. Seed 1: equal. Seed 2: only the slow one arrives. Seed 3: only the fast one.
    curves = {line.get_label(): line.get_xydata() for line in made["performance"].axes[0].get_lines()}
    assert [float(x) for x, _ in curves["fast"]] == pytest.approx([1, 1, 1, 1, 2.1])
    assert [float(y) for _, y in curves["fast"]] == pytest.approx([0, 25, 50, 75, 75])
    assert [float(x) for x, _ in curves["slow"]] == pytest.approx([1, 1, 1, 2, 2.1])
    assert [float(y) for _, y in curves["slow"]] == pytest.approx([0, 25, 50, 75, 75])
    bars = made["rates"].axes[0].patches
    assert sorted(round(bar.get_width()) for bar in bars) == [0, 75, 75, 75]
    ends = [patch.get_width() for patch in made["endings"].axes[0].patches]
    assert ends == [75, 75, 25, 25]


def test_what_there_is_not_is_not_drawn(drawn: Drawn) -> None:
    assert list(drawn([row("one", 10.0)])) == ["endings", "rates", "pets"]
    broken = EpisodeRecord("merge", "m", "", "none", 0, Outcome(Ending.ERROR, 1.0, {}), {}, (), 4, {})
    assert list(drawn([DrawnRow("one", "merge", CellResults([broken]))])) == ["endings"]


LONG = "codriving no_negotiation/own_view/order=cooperative_game_with_a_long_name"


@pytest.mark.parametrize(
    ("names", "blocks"),
    [(["fcfs"], 1), ([f"method {k}" for k in range(12)], 1), ([LONG, f"{LONG} 2", "$x_{$", "_a"], 2), (["a", "b"], 4)],
)
def test_nothing_lies_under_the_legend_and_nothing_is_cut(drawn: Drawn, names: list[str], blocks: int) -> None:
    rows = [row(name, 10.0, 12.0, block=f"merge\ndrivers={k}") for k in range(blocks) for name in names]
    # One of bars and one of curves: the others are laid out alike.
    for name, figure in drawn(rows, "rates", "trade-off").items():
        legend = figure.legends[0].get_window_extent()
        boxes = [text.get_window_extent() for text in figure.texts if text.get_text()]
        boxes += [axis.get_tightbbox() for axis in figure.axes if axis.axison]
        assert not any(legend.overlaps(box) for box in boxes), name
        width, height = figure.bbox.size + 1
        inside = [b.x0 >= -1 and b.y0 >= -1 and b.x1 <= width and b.y1 <= height for b in (legend, *boxes)]
        assert all(inside), name
        shown = [text.get_text() for text in figure.legends[0].get_texts()]
        assert len(shown) == len(set(shown)) == {"rates": 2}.get(name, len(names))


def test_more_panels_and_rows_than_can_be_told_apart_are_left_out(drawn: Drawn) -> None:
    made = drawn([row("a", 10.0, block=f"block {k}") for k in range(9)], "endings")
    assert len(made["endings"].axes) == 8
    made = drawn([row(f"row {k}", 10.0) for k in range(25)], "pets")
    looks = {(line.get_color(), line.get_linestyle()) for line in made["pets"].axes[0].get_lines()}
    assert len(made["pets"].legends[0].get_texts()) == 24
    assert len(looks) == 25, "24 rows and the line of 1.5 s"
