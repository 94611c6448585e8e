"""The tables of flows: means over seeds and their intervals, and nothing of success or of pairs."""

from collections.abc import Mapping

import pytest

from codriving.datatypes.record import Ending, EpisodeRecord, FlowLog, NamedNumber, Outcome, Score
from codriving.reports.flows import flow_table, flow_tables, print_flows
from codriving.reports.results import CellResults
from tests.reports.making import column_of, printed_text

DEFINED = {
    "demand": 1200.0,
    "throughput": 1100.0,
    "delay": 4.0,
    "delay_cavs": 3.0,
    "delay_hdvs": 5.0,
    "collisions": 0.0,
    "collisions_cavs": 0.0,
    "off_road": 0.0,
    "vehicles": 40.0,
    "collisions_per_1000": 0.0,
    "velocity": 6.5,
    "hard_braking": 1.25,
    "waiting": 0.0,
}


def flow(seed: int, method: str = "fcfs", **numbers: float | None) -> EpisodeRecord:
    values: Mapping[str, float | None] = {**DEFINED, **numbers}
    score = Score(None, numbers=tuple(NamedNumber(name, value) for name, value in values.items()))
    outcome = Outcome(Ending.COUNTED, 150.0, {}, flow=FlowLog(30.0, 0.1, (), ()))
    return EpisodeRecord("intersection", method, "", "none", seed, outcome, {"standard": score}, (), 300, {"plans": 2})


def failed(seed: int) -> EpisodeRecord:
    outcome = Outcome(Ending.ERROR, 3.0, {}, message="RuntimeError: broke")
    return EpisodeRecord("intersection", "fcfs", "", "none", seed, outcome, {}, (), 6, {})


def test_means_over_seeds_with_intervals_from_ten_seeds_on() -> None:
    records = [flow(k, delay=d, throughput=1000.0 + 20 * k) for k, d in enumerate([2.0, 4.0] * 5)]
    (row,) = flow_table([CellResults(records)]).rows
    assert (row["delay"], row["throughput"], row["velocity"]) == (3.0, 1090.0, 6.5)
    assert 2.2 < float(row["delay_low"] or 0) < 3.0 < float(row["delay_high"] or 0) < 3.8
    assert (row["velocity_low"], row["velocity_high"]) == (6.5, 6.5)
    (few,) = flow_table([CellResults(records[:9])]).rows
    assert few["delay_low"] is None
    assert few["delay_text"] == "2.9"
    (none,) = flow_table([CellResults([flow(0, delay=-0.04)])]).rows
    assert none["delay_text"] == "0.0"


def test_collisions_are_those_of_all_seeds_together() -> None:
    """2 collisions of 20 and 180 vehicles are 10 of 1,000; the mean of the seeds' own rates would be 50."""
    two = [
        flow(0, collisions=2.0, collisions_cavs=1.0, vehicles=20.0, collisions_per_1000=100.0),
        flow(1, vehicles=180.0),
    ]
    (row,) = flow_table([CellResults(two)]).rows
    assert row["hits"] == "2 (1)"
    assert (row["collisions_per_1000"], row["collisions"], row["vehicles"]) == (10.0, 2.0, 200.0)
    (none,) = flow_table([CellResults([flow(k) for k in range(10)])]).rows
    assert none["collisions_per_1000_text"] == "0.0 (0.0 to 7.5)", "3 of 400"


def test_what_broke_off_counts_nowhere_and_is_shown() -> None:
    shown = print_flows([CellResults([flow(0, delay=2.0), failed(1)])], "standard")
    assert column_of(shown, "seeds") == ["1/2"]
    assert column_of(shown, "error") == ["50 %"]
    assert column_of(shown, "delay [s] (95 %)") == ["2.0"]
    (row,) = flow_table([CellResults([failed(0)])]).rows
    assert (row["delay"], row["throughput"], row["collisions_per_1000"]) == (None, None, None)


def test_neither_success_nor_pairs_are_in_any_table() -> None:
    cells = [
        CellResults([flow(k, method) for k in range(2)], {"flow.arrivals": "300.0"}) for method in ("fcfs", "mcts")
    ]
    tables = flow_tables(cells, "standard")
    texts = [tables.episodes.csv(), tables.summary.csv(), printed_text(tables.printed), printed_text(tables.page)]
    for text in texts:
        assert not [word for word in ("success", "mcnemar", "clean", "pet") if word in text.lower()]
    assert tables.summary.keys[:7] == (
        *("scenario", "method", "variant", "reasoner", "flow.arrivals", "episodes", "completed"),
    )
    assert "plans" in tables.summary.keys
    assert [row["outcome"] for row in tables.episodes.rows] == ["counted"] * 4
    assert tables.printed.title == "flow - intersection - reasoner: none"


def test_computing_time_is_on_the_screen_alone() -> None:
    cells = [CellResults([flow(0)], cpu=0.0125)]
    assert column_of(print_flows(cells, "standard", screen=True), "CPU [ms]") == ["12.5"]
    assert "CPU [ms]" not in print_flows(cells, "standard").columns


def test_a_number_of_the_users_own_metric_has_a_column() -> None:
    (row,) = flow_table([CellResults([flow(0, queue=3.0), flow(1, queue=5.0)])]).rows
    assert row["queue"] == pytest.approx(4.0)


def test_what_has_to_be_known_of_a_method_stands_below() -> None:
    cells = [CellResults([flow(0)], remark="trained in another world"), CellResults([flow(0, "mcts")])]
    assert "trained in another world" in print_flows(cells, "standard").notes
