"""Where a curve breaks, the area under it, and what tables and figure show of it."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace

import pytest

from codriving.config.choices import styles
from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.datatypes.stress import StressAxis, StressLevel
from codriving.reports.results import CellResults
from codriving.reports.stress import StressCurve, breaking_table, print_stress, stress_table
from codriving.reports.stress_figure import stress_figure
from tests.reports.making import column_of

Make = Callable[..., EpisodeRecord]

AGE = StressAxis("age", "age", "s", "Old messages.", tuple(StressLevel(value, ()) for value in (0.1, 0.5, 1.0, 2.0)))


@pytest.fixture
def curve(make: Make) -> Callable[..., StressCurve]:
    """A curve whose levels fail on the first seeds, so that what fails at one level fails at a worse one, too."""

    def made(failing: Sequence[int], unclean: Sequence[int] = (), seeds: int = 100, **told: str) -> StressCurve:
        at = {}
        for level, number in enumerate(failing):
            late = number + (unclean[level] if unclean else 0)
            at[level] = CellResults(
                [
                    make(
                        seed,
                        Ending.TIMEOUT if seed < number else Ending.SUCCESS,
                        velocities=(8.0 - level,),
                        clean=seed >= late if unclean else None,
                        **told,
                    )
                    for seed in range(seeds)
                ]
            )
        return StressCurve(AGE, at)

    return made


@pytest.mark.parametrize(
    ("failing", "level"),
    [
        ((0, 4, 4, 4), "never"),  # 4 points, however surely
        (
            (0, 5, 0, 0),
            1,
        ),  # 5 points and an interval from -11.2 to -1.2: the first level, though the next ones are as good
        ((0, 4, 5, 30), 2),
        ((0, 0, 0, 6), 3),
        ((10, 14, 14, 14), "never"),
        ((50, 30, 10, 0), "never"),  # Better from level to level
        ((100, 100, 100, 100), "never"),
    ],
)
def test_success_breaks_where_it_is_5_points_lower(
    failing: tuple[int, ...], level: int | str, curve: Callable[..., StressCurve]
) -> None:
    assert curve(failing).breaks("success") == level


def test_nothing_breaks_where_the_interval_includes_0(make: Make, curve: Callable[..., StressCurve]) -> None:
    """20 of 100 seeds fail at the first level, 28 others at the second one: 8 points, -20.1 to 4.4."""
    records = [make(seed, Ending.TIMEOUT if 50 <= seed < 78 else Ending.SUCCESS) for seed in range(100)]
    found = curve((20, 20, 20, 20))
    found = replace(found, at={**found.at, 1: CellResults(records)})
    rate = found.change("success", 1)
    assert (rate.gained, rate.lost, rate.difference) == (20, 28, -0.08)
    low, high = rate.interval or (0.0, 0.0)
    assert -0.22 < low < -0.19
    assert 0.03 < high < 0.06
    assert found.breaks("success") == "never"


def test_few_seeds_do_not_show_what_more_seeds_do(curve: Callable[..., StressCurve]) -> None:
    """4 of 60 are 6.7 points, and the interval ends at 0.6; 5 of 60 end at -0.7."""
    assert curve((0, 4, 4, 4), seeds=60).breaks("success") == "never"
    assert curve((0, 4, 4, 5), seeds=60).breaks("success") == 3


def test_it_is_the_methods_own_first_level_that_counts(curve: Callable[..., StressCurve]) -> None:
    assert curve((40, 42, 44, 44)).breaks("success") == "never"
    assert curve((40, 42, 44, 45)).breaks("success") == 3


def test_clean_success_breaks_where_it_is_10_points_lower(curve: Callable[..., StressCurve]) -> None:
    assert curve((0, 0, 0, 0), (0, 9, 9, 10)).breaks("clean") == 3
    assert curve((0, 0, 0, 0), (0, 9, 9, 9)).breaks("clean") == "never"
    found = curve((0, 6, 0, 0), (0, 3, 12, 0))
    assert (found.breaks("success"), found.breaks("clean")) == (1, 2)


def test_of_few_pairs_and_of_missing_levels_nothing_is_said(curve: Callable[..., StressCurve]) -> None:
    assert curve((0, 9, 9, 9), seeds=9).breaks("success") is None
    assert curve((0, 10, 10, 10), seeds=10).breaks("success") == 1
    assert curve((0, 0, 0, 0)).breaks("clean") is None, "where no metric says what is clean"
    whole = curve((0, 0, 0, 50))
    for missing in (0, 2):
        found = replace(whole, at={k: cell for k, cell in whole.at.items() if k != missing})
        assert found.breaks("success") is None
        assert found.area("success") is None


def test_a_level_is_paired_by_seed_without_errors(make: Make, curve: Callable[..., StressCurve]) -> None:
    found = curve((0, 0, 0, 0), seeds=20)
    records = [make(seed, Ending.ERROR if seed < 5 else Ending.TIMEOUT) for seed in range(19, -1, -1)]
    rate = replace(found, at={**found.at, 1: CellResults(records)}).change("success", 1)
    assert (rate.pairs, rate.lost) == (15, 15)


def test_the_area_is_the_mean_over_the_span(curve: Callable[..., StressCurve]) -> None:
    """100, 80, 60 and 20 % at 0.1, 0.5, 1 and 2 s: (0.4 x 90 + 0.5 x 70 + 1 x 40) / 1.9."""
    found = curve((0, 20, 40, 80), (0, 0, 0, 20))
    assert found.area("success") == pytest.approx(1.11 / 1.9)
    assert found.area("clean") == pytest.approx(1.01 / 1.9)
    assert curve((0, 0, 0, 0)).area("success") == 1.0


def test_levels_keep_the_order_of_the_axis_whatever_came_first(curve: Callable[..., StressCurve]) -> None:
    found = curve((0, 0, 6, 80))
    backwards = replace(found, at=dict(reversed(found.at.items())))
    assert backwards.breaks("success") == 2
    assert backwards.area("success") == found.area("success")
    assert stress_table([backwards]).csv() == stress_table([found]).csv()
    shown = print_stress([backwards], "standard")[0]
    assert shown.columns[2:6] == ("0.1 s", "0.5 s", "1 s", "2 s")
    assert shown.rows[0].cells[2:6] == (
        "100 % (96.3 to 100)", "100 % (96.3 to 100)", "94 % (87.5 to 97.2)", "20 % (13.3 to 28.9)"
    )  # fmt: skip


def test_tables_say_where_each_curve_breaks(curve: Callable[..., StressCurve]) -> None:
    curves = [
        curve((0, 0, 6, 80), (0, 0, 0, 0)),
        curve((0, 0, 0, 0), (0, 0, 0, 12), method="fcfs", variant="", reasoner="none"),
    ]
    success, clean, velocity = print_stress(curves, "standard", (), ["A note."])
    assert success.title == "stress: age [s] - intersection - reasoner: rules (llm=offline), none - success (95 %)"
    assert [clean.title, velocity.title] == ["age [s] - clean success (95 %)", "age [s] - velocity [m/s]"]
    assert column_of(success, "breaks at") == ["1 s: -6.0 (-12.5 to -1.1)", "never"]
    assert column_of(clean, "breaks at") == ["2 s: -80.0 (-86.7 to -70.4)", "2 s: -12.0 (-19.8 to -5.8)"]
    assert column_of(success, "area") == ["76.6 %", "100 %"]
    assert column_of(velocity, "2 s") == ["5.00", "5.00"]
    assert (success.notes, velocity.notes) == ((), ("Old messages.", "A note."))
    rows = breaking_table(curves).rows
    assert [(row["success_breaks_at"], row["clean_breaks_at"]) for row in rows] == [(1.0, 2.0), ("never", 2.0)]


def test_without_clean_success_there_is_no_table_of_it(curve: Callable[..., StressCurve]) -> None:
    tables = print_stress([curve((0, 0, 6, 80))], "standard")
    assert [table.title.rpartition(" - ")[2] for table in tables] == ["success (95 %)", "velocity [m/s]"]


def test_a_figure_has_a_line_a_method_and_a_ring_where_it_breaks(curve: Callable[..., StressCurve]) -> None:
    curves = [curve((0, 0, 6, 80), (1, 0, 0, 0)), curve((0, 0, 0, 0), method="fcfs", variant="", reasoner="none")]
    found = stress_figure(curves, "standard", styles())
    assert set(found) == {"stress-age.png", "stress-age.svg"}
    assert stress_figure(curves, "standard", styles()) == found
    svg = found["stress-age.svg"].decode()
    said = set(re.findall(r"<!-- (.*?) -->", svg))
    assert {"0.1 s", "2 s", "age [s]", "codriving full", "fcfs", "intersection", "success [%], 95 % interval"} <= said
    assert svg != stress_figure([curve((0, 0, 0, 80), (1, 0, 0, 0)), curves[1]], "standard", styles())["stress-age.svg"]


def test_rings_are_where_curves_break(curve: Callable[..., StressCurve], monkeypatch: pytest.MonkeyPatch) -> None:
    from matplotlib.axes import Axes

    rings = []
    plain = Axes.plot

    def noted(self: Axes, *args: object, **told: object) -> object:
        if told.get("mfc") == "none":
            rings.append((args[0], args[1]))
        return plain(self, *args, **told)  # type: ignore[arg-type]

    monkeypatch.setattr(Axes, "plot", noted)
    stress_figure([curve((0, 0, 6, 80), (0, 20, 0, 0))], "standard", styles())
    assert rings == [([2.0], [94.0]), ([1.0], [80.0])]
