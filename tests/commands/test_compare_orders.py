"""``codriving compare orders``: one method with each passing order, and nothing else varies."""

import csv
from pathlib import Path
from typing import Any

import pytest

from codriving.commands import comparison_command, run_command
from codriving.commands.compare import comparison
from codriving.config.compose import compose
from codriving.config.sweep import Point
from codriving.errors import ConfigError

ORDERS = ("negotiated", "fcfs", "idfst", "mcts", "coop_game", "optimal", "random")
EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "nearest_first" / "conf"


def rows_of(points: list[Point]) -> list[tuple[str, str]]:
    return [(point.swept["method"], point.swept["order"]) for point in points]


def test_the_rows_are_the_reference_with_each_order() -> None:
    points = comparison("orders", ["episodes=3"])
    assert rows_of(points) == [("codriving", name) for name in ORDERS]
    assert points[1].overrides == ("experiment=compare-orders", "episodes=3", "order=fcfs", "method=codriving")


def test_the_rows_differ_in_the_order_alone() -> None:
    def without(config: dict[str, Any]) -> dict[str, Any]:
        method = {key: value for key, value in config["method"].items() if key != "order"}
        return {**{key: value for key, value in config.items() if key != "order"}, "method": method}

    configs = [compose(point.overrides) for point in comparison("orders", ["suite=paper"])[:3]]
    assert without(configs[0]) == without(configs[1]) == without(configs[2])
    assert [config["method"]["order"] is None for config in configs] == [True, False, False]


def test_orders_and_methods_are_added() -> None:
    points = comparison("orders", ["order=nearest_first,fcfs", "method=mcts,codriving"], EXAMPLE)
    assert rows_of(points)[len(ORDERS) :] == [("codriving", "nearest_first"), ("mcts", "")]


@pytest.mark.parametrize("token", ["flow=steady", "scenario.cavs=11"])
def test_what_orders_few_cavs_is_left_out_where_there_may_be_more(token: str) -> None:
    assert [name for _, name in rows_of(comparison("orders", [token]))] == [n for n in ORDERS if n != "optimal"]


def test_ten_cavs_are_not_too_many() -> None:
    assert ("codriving", "optimal") in rows_of(comparison("orders", ["scenario.cavs=10"]))


def test_each_setting_is_a_block_of_all_orders() -> None:
    points = comparison("orders", ["scenario.cavs=4,12"])
    assert [point.swept["scenario.cavs"] for point in points] == ["4"] * 7 + ["12"] * 6


@pytest.mark.parametrize(
    ("tokens", "said"),
    [
        (["order=typo"], "unknown order 'typo'; choices: negotiated, fcfs, "),
        (["method=typo"], "unknown method 'typo'; choices: fcfs, "),
        (["episodes=3,4"], "episodes takes one value"),
    ],
)
def test_what_cannot_be_compared_is_refused(tokens: list[str], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        comparison_command("orders").points(tokens, None)


def run(folder: Path, name: str, *tokens: str) -> Path:
    short = ("launcher=serial", "scenario.time_limit=2", "seed=10000", f"run={name}", f"output={folder}")
    assert run_command(comparison_command("orders"), [*short, *tokens], None) == 0
    return folder / "compare-orders" / name


def table(folder: Path) -> list[dict[str, str]]:
    with (folder / "comparison.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_comparison_of_orders_is_a_run_with_a_row_each(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = run(tmp_path, "x", "episodes=2", "suite=paper", "method=fcfs", "scenario.hdvs=[1,1]")
    found = table(folder)
    variants = ["full", *(f"order={name}" for name in ORDERS[1:]), ""]
    assert sorted(row["variant"] for row in found) == sorted(variants)
    assert {row["variant"]: row["pairs"] for row in found} == {name: "" if name == "full" else "2" for name in variants}
    assert not any(row[key] for row in found for key in row if key.startswith("paper_"))
    out, page = capsys.readouterr().out, (folder / "comparison.md").read_text()
    for text in (out, page):
        assert "comparison of passing orders - intersection" in text
        assert "against order=negotiated on the same seeds" in text
        assert "codriving order=negotiated" in text
        assert "One thing varies between the rows of codriving: by which rule CAVs pass in what order (order=)." in text
        assert "Each difference is the order minus order=negotiated on the same seeds." in text
        assert "Rows of other methods differ in more than the order" in text
        assert "codriving full" not in text
        assert "against codriving" not in text
    assert len(list((folder / "episodes").iterdir())) == 8


def test_a_comparison_of_orders_in_flows_says_what_varies(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    flow = ("flow=steady", "flow.warm_up=0", "flow.window=10", "flow.arrivals=100")
    folder = run(tmp_path, "f", "episodes=1", *flow)
    assert [row["variant"] for row in table(folder)] == ["full", *(f"order={n}" for n in ORDERS[1:] if n != "optimal")]
    out = capsys.readouterr().out
    assert "codriving full goes by the negotiated order." in out
    assert "Left out: order=optimal, which orders at most 10 CAVs." in out
