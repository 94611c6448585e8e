"""Every cell is checked before the first episode, and a refusal names the cell that it is about."""

import pytest

from codriving.commands.ablation import ablation_points
from codriving.config.sweep import Point, expand
from codriving.errors import ConfigError
from codriving.experiment.plan import cell_name, composed, make_plan, validated


def refused(*tokens: str) -> str:
    with pytest.raises(ConfigError) as err:
        make_plan(expand(tokens))
    assert "\n" not in str(err.value)
    return str(err.value)


@pytest.mark.parametrize(
    ("tokens", "said"),
    [
        # One cell of several is wrong, wherever it stands.
        (["scenario.cavs=4,99"], "in the cell scenario.cavs=99: scenario.cavs must be 2 to 12, got 99"),
        (["scenario.cavs=99,4"], "in the cell scenario.cavs=99: scenario.cavs must be 2 to 12, got 99"),
        (["cda=full,prescriptive", "cda.negotiation=false"], "in the cell cda=prescriptive: cda.binding=true needs"),
        (["scenario.cavs=4,8", "cda.own_order=own_view,mine"], "in the cell scenario.cavs=4 cda.own_order=mine: cda."),
        # All are wrong, each in a way of its own.
        (["scenario.cavs=98,99"], "in the cell scenario.cavs=98: scenario.cavs must be 2 to 12, got 98"),
        # All are wrong in the same way.
        (["scenario.cavs=4,8", "episodes=0"], "episodes must be a whole number, 1 to 100000, got 0"),
        (["scenario.cavs=4,8", "scenario.typo=1"], "unknown key scenario.typo; "),
        (["scenario.cvas=4,8"], "unknown key scenario.cvas; did you mean scenario.cavs?"),
        (["scenario.cavs=99"], "scenario.cavs must be 2 to 12, got 99"),
    ],
)
def test_a_refusal_names_the_cell_unless_it_holds_for_all(tokens: list[str], said: str) -> None:
    assert refused("scenario=intersection", "launcher=serial", *tokens).startswith(said)


def test_the_error_keeps_its_class_and_cause() -> None:
    points = expand(["scenario.cavs=4,99"])
    with pytest.raises(ConfigError) as err:
        validated(points, composed(points)[0])
    assert isinstance(err.value.__cause__, ConfigError)


def test_an_ablated_cell_is_named_by_what_was_removed() -> None:
    full, *_, unchecked = ablation_points(["scenario.cavs=4,8", "controls=false"])[7:]
    assert cell_name(full) == "scenario.cavs=8"
    assert cell_name(unchecked) == "scenario.cavs=8 cda.safety_check=false"
    assert cell_name(ablation_points([])[0]) == "with nothing removed"


def test_a_secret_is_no_name() -> None:
    point = Point((), {"llm.api_key": "sk-canary", "llm.max_tokens": "200", "scenario.cavs": "4"})
    assert cell_name(point) == "llm.api_key=<redacted> llm.max_tokens=200 scenario.cavs=4"


def test_what_belongs_to_the_run_cannot_follow_a_swept_key() -> None:
    text = refused("launcher=serial", "scenario.cavs=4,8", "run=with-${scenario.cavs}")
    expected = "run is with-4 in the cell scenario.cavs=4 and with-8 in the cell scenario.cavs=8; it belongs to the run"
    assert text.startswith(expected)


def test_a_plan_has_one_cell_for_each_combination_and_one_batch_of_seeds() -> None:
    plan = make_plan(expand(["launcher=serial", "scenario.cavs=4,8", "cda=full,prescriptive", "episodes=3", "seed=7"]))
    assert [cell.folder for cell in plan.cells] == [
        "intersection-codriving-full-scenario.cavs=4",
        "intersection-codriving-full_binding-scenario.cavs=4",
        "intersection-codriving-full-scenario.cavs=8",
        "intersection-codriving-full_binding-scenario.cavs=8",
    ]
    assert list(plan.seeds) == [7, 8, 9]
    assert plan.notes == ()


def test_values_that_come_to_the_same_are_one_row_and_a_note() -> None:
    plan = make_plan(expand(["launcher=serial", "cda=full,agreement_seeking"]))
    assert [cell.folder for cell in plan.cells] == ["intersection-codriving-full"]
    (note,) = plan.notes
    assert note == (
        "codriving full: cda=agreement_seeking is the same configuration as cda=full and has no row of its own."
    )


def test_what_a_method_takes_no_notice_of_is_said() -> None:
    def notes(*tokens: str) -> tuple[str, ...]:
        return make_plan(expand(["launcher=serial", *tokens])).notes

    assert notes("method=fcfs,random_order,codriving,idm", "order=mcts", "filter=true") == (
        "order=mcts has no effect on fcfs, random_order, idm: what orders by itself, or not at all, does not read it.",
        "filter=true has no effect on random_order, codriving, idm: what has this check or gives no actions is not "
        "filtered.",
    )
    assert notes("method=codriving,oracle", "order=mcts") == ()
    assert notes("method=fcfs,codriving", "filter=true", "cda.safety_check=false") == ()
