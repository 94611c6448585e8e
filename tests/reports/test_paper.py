"""The paper's numbers and statements as they are shipped: one of each for every scenario, and none made up."""

import pytest

from codriving.config.locate import experiments_dir
from codriving.reports.paper import WHOLE, read_paper

PAPER = read_paper(experiments_dir())
SCENARIOS = ("intersection", "roundabout", "highway", "merge")


@pytest.mark.parametrize(
    ("scenario", "variant", "words"),
    [
        ("intersection", "no_negotiation", "below 15 %"),
        ("roundabout", "no_negotiation", "below 15 %"),
        ("highway", "no_negotiation", ""),
        ("merge", "no_negotiation", ""),
        ("intersection", "no_state_sharing", "above 50 %"),
        ("roundabout", "no_state_sharing", "above 50 %"),
        ("highway", "no_state_sharing", "above 50 %"),
        ("merge", "no_state_sharing", "close to the full method"),
        ("intersection", "no_intent_sharing", "small effect"),
        ("roundabout", "no_intent_sharing", "clear drop"),
        ("highway", "no_intent_sharing", "high with and without"),
        ("merge", "no_intent_sharing", "small effect"),
    ],
)
def test_a_statement_is_that_of_its_scenario(scenario: str, variant: str, words: str) -> None:
    statement = PAPER.statement(scenario, variant)
    assert words in statement
    assert bool(statement) == bool(words)


def test_every_scenario_has_every_row_of_the_papers_ablation() -> None:
    variants = {(s.scenario, s.variant) for s in PAPER.ablation}
    removed = ("full", "no_state_sharing", "no_intent_sharing", "no_negotiation")
    assert variants == {(scenario, variant) for scenario in SCENARIOS for variant in removed}


def test_a_reading_is_ours_and_what_the_paper_does_not_remove_has_no_statement() -> None:
    reading = PAPER.statement("roundabout", "no_negotiation/same_rule")
    assert reading == PAPER.statement("roundabout", "no_negotiation")
    assert PAPER.statement("intersection", "no_safety_check") == ""
    assert PAPER.statement("intersection", "full/binding") == ""
    assert PAPER.statement("t_junction", "no_negotiation") == ""


def test_methods_are_compared_at_the_intersection_alone() -> None:
    assert {row.scenario for row in PAPER.comparison} == {"intersection"}
    assert all(PAPER.row("roundabout", "codriving", variant) is None for variant in WHOLE)
    assert PAPER.row("intersection", "codriving", "full") is not None
