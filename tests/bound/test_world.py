"""No result of any method lies below the bound."""

import csv
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from bounded_results import driven, overrides

from codriving.bound.world import BoundedWorld
from codriving.config.compose import compose
from codriving.experiment.objects import make_objects

HERE = Path(__file__).parent

Row = dict[str, str]

FRESH = 20  # Scenes that are solved, and driven, in the tests


@cache
def rows(name: str) -> tuple[Row, ...]:
    with (HERE / name).open(encoding="utf-8", newline="") as file:
        return tuple(csv.DictReader(file))


def scene(row: Row) -> tuple[str, ...]:
    return tuple(row[key] for key in ("scenario", "suite", "cavs", "hdvs", "seed"))


def test_no_result_of_a_thousand_lies_below_the_bound_that_is_stored() -> None:
    bounds = {scene(row): float(row["bound"]) for row in rows("bounds.csv")}
    results = [row for row in rows("results.csv") if row["total"]]
    assert len(results) >= 1000
    assert not [row for row in results if float(row["total"]) < bounds[scene(row)] - 1e-6]
    # Some come so near that a bound 2 % higher would be refuted.
    assert sum(float(row["total"]) < 1.02 * bounds[scene(row)] for row in results) > 50
    cells = {(row["scenario"], row["suite"], row["cavs"], row["hdvs"], row["method"]) for row in results}
    assert len(cells) == 2 * 2 * 4 * 5


def test_stored_bounds_are_those_of_this_version(world: Callable[..., BoundedWorld]) -> None:
    few = [row for row in rows("bounds.csv") if row["cavs"] == "8"]
    assert len(few) >= 40
    for row in few[:: len(few) // FRESH][:FRESH]:
        at = world(*overrides(row["scenario"], row["suite"], int(row["cavs"]), row["hdvs"] == "some"))
        assert at.solve(int(row["seed"])).total == pytest.approx(float(row["bound"]), abs=1e-6), row


@pytest.mark.parametrize(("scenario", "method"), [("intersection", "mcts"), ("roundabout", "idfst")])
def test_what_is_driven_now_does_not_lie_below(world: Callable[..., BoundedWorld], scenario: str, method: str) -> None:
    settings = overrides(scenario, "default", 4, False)
    at, objects = world(*settings), make_objects(compose([*settings, f"method={method}"]))
    totals = {seed: driven(objects, seed) for seed in range(27_000, 27_000 + FRESH // 2)}
    assert all(total is not None and total >= at.solve(seed).total - 1e-6 for seed, total in totals.items())
