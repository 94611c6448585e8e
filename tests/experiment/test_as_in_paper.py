"""The paper's numbers stand beside its own setting alone."""

from types import SimpleNamespace
from typing import Any, cast

import pytest

from codriving.config.sweep import expand
from codriving.experiment.as_in_paper import results_of
from codriving.experiment.plan import make_plan


def stands(*overrides: str, seeds: range = range(20)) -> tuple[bool, bool]:
    """Whether a cell has the paper's setting, and whether also its number of seeds."""
    (cell,) = make_plan(expand(["launcher=serial", "suite=paper", *overrides])).cells
    results = results_of(cell, [cast(Any, SimpleNamespace(seed=seed)) for seed in seeds], {})
    return results.papers_setting, results.as_in_paper


def test_the_shipped_scenario_on_twenty_seeds_is_the_papers() -> None:
    assert stands() == (True, True)
    assert stands("cda.negotiation=false", "method.margin=1.0") == (True, True)


@pytest.mark.parametrize("seeds", [range(200), range(2), range(1000, 1020)])
def test_other_seeds_are_not(seeds: range) -> None:
    assert stands(seeds=seeds) == (True, False)


@pytest.mark.parametrize(
    "override",
    [
        "scenario.cavs=8",
        "scenario.hdvs=[0,0]",
        "scenario.time_limit=20",
        "drivers.headway=1.2",
        "drivers=attentive",
        "limits=road",
        "thinking.order=1",
        "v2x=good",
        "suite=default",
        "environment.corrections.no_reverse=false",
    ],
)
def test_another_setting_is_not(override: str) -> None:
    assert stands(override) == (False, False)
