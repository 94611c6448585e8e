"""A judge that was chosen is a part of what a run is, and of what is said below its table."""

import pytest

from codriving.config.compose import compose_named
from codriving.experiment.cells import Cell, make_cell, without_effect


def cell(*overrides: str) -> Cell:
    """The cell of some overrides."""
    resolved, choices = compose_named(["suite=paper", *overrides])
    return make_cell(resolved, None, choices)


def test_the_default_is_no_part_of_a_run_and_another_judge_is() -> None:
    ruled, judged = cell("method=fcfs"), cell("method=fcfs", "judgement=earliest")
    assert not [key for key in ruled.entry().settings if "judgement" in key]
    assert judged.entry().settings["judgement.lead"] == "1.0"
    assert judged.fingerprint != ruled.fingerprint
    assert judged.fingerprint != cell("method=fcfs", "judgement=never").fingerprint


def test_coefficients_are_told_by_their_content() -> None:
    assert [file.name for file in cell("method=fcfs", "judgement=learned").files] == ["coefficients"]


@pytest.mark.parametrize(("method", "judge"), [("pidm", "earliest"), ("codriving", "llm"), ("fcfs", "llm")])
def test_what_asks_no_judge_says_so(method: str, judge: str) -> None:
    (said,) = without_effect([cell(f"method={method}", f"judgement={judge}")])
    assert said.startswith(f"judgement={judge} has no effect on {method}: ")


def test_what_asks_one_says_nothing() -> None:
    assert without_effect([cell("method=fcfs", "judgement=earliest")]) == ()
