"""The paper's method: what is in the slots, and that it drives."""

from collections.abc import Callable
from typing import Any

import pytest
from asked import reasoned
from worlds import Junction, car

from codriving.datatypes.record import Ending
from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.environment import Environment
from codriving.errors import ConfigError, ModelUnavailableError
from codriving.llm.language_model import Offline
from codriving.llm.question import Question
from codriving.methods.codriving import CoDriving
from codriving.reasoning.ordering.negotiation import AgreedOrder, OwnOrders
from codriving.reasoning.safety.assessment import NoCheck, ThreeLayers
from codriving.reasoning.sharing.sharing import HIDDEN_INTENTS, SHARED_INTENTS, CdaLevel, SensedStates, SharedStates

Make = Callable[..., CoDriving]


@pytest.mark.parametrize(
    ("change", "slot", "kind"),
    [
        ({}, "state_sharing", SharedStates),
        ({"state_sharing": False}, "state_sharing", SensedStates),
        ({}, "intent_sharing", SHARED_INTENTS),
        ({"intent_sharing": False}, "intent_sharing", HIDDEN_INTENTS),
        ({}, "negotiation", AgreedOrder),
        ({"negotiation": False}, "negotiation", OwnOrders),
        ({}, "safety", ThreeLayers),
        ({"safety_check": False}, "safety", NoCheck),
    ],
)
def test_an_ablation_puts_another_object_into_one_slot(
    change: dict[str, Any], slot: str, kind: object, method: Make
) -> None:
    pipeline = method(**change).pipeline
    found = getattr(pipeline if hasattr(pipeline, slot) else pipeline.perception, slot)
    assert kind in (found, type(found))


def test_readings_and_binding_reach_the_order(method: Make, junction: Junction) -> None:
    own = method(negotiation=False, own_order="independent", seed=7).pipeline.negotiation
    assert isinstance(own, OwnOrders)
    assert (own.reading, own.seed) == ("independent", 7)
    world = junction.world(car("CAV1", "south-north", 60.0, 8.0), car("CAV2", "west-east", 60.0, 8.0))
    for binding in (False, True):
        assert {s.order.binding for s in method(binding=binding).act(world).situations} == {binding}


def test_names_for_tables(method: Make) -> None:
    made = method(negotiation=False, own_order="same_rule")
    assert (made.name, made.variant, made.reasoner) == ("codriving", "no_negotiation/same_rule", "rules")


@pytest.mark.parametrize("margin", [-0.1, 5.1])
def test_a_margin_out_of_range_is_refused(margin: float) -> None:
    with pytest.raises(ConfigError, match="margin must be 0 to 5 s"):
        CoDriving(CdaLevel(True, True, True, True, False, "own_view"), Offline(), None, margin)


def drive(method: CoDriving, environment: Environment) -> tuple[Environment, list[set[Action]]]:
    world, taken = environment.reset(0), []
    method.reset(environment.road_map, environment.driving_model, 0)
    while environment.outcome is None:
        actions = method.act(world).actions
        taken.append(set(actions.values()))
        world = environment.step(actions)
    return environment, taken


@pytest.mark.parametrize("change", [{}, {"state_sharing": False}, {"negotiation": False}, {"intent_sharing": False}])
def test_a_cav_on_its_own_accelerates_all_the_way(change: dict[str, Any], method: Make, junction: Junction) -> None:
    environment, taken = drive(method(**change), junction.drive(Start("CAV1", Kind.CAV, "south-west", 60.0, 5.0)))
    assert environment.outcome is not None
    assert environment.outcome.ending is Ending.SUCCESS
    assert taken == [{Action.FASTER}] * len(taken)


@pytest.mark.parametrize(
    "routes", [("south-north", "west-east"), ("south-west", "north-south"), ("west-north", "south-north")]
)
@pytest.mark.parametrize("binding", [False, True])
def test_two_cavs_in_conflict_get_through(
    routes: tuple[str, str], binding: bool, method: Make, junction: Junction
) -> None:
    starts = [Start(f"CAV{k + 1}", Kind.CAV, route, 60.0 + k, 8.0) for k, route in enumerate(routes)]
    environment, _ = drive(method(binding=binding), junction.drive(*starts))
    assert environment.outcome is not None
    assert environment.outcome.ending is Ending.SUCCESS
    # One of them waits for the other one, but neither comes to a long stop.
    assert max(environment.outcome.arrivals.values()) < 20.0


def test_an_episode_begins_without_memories_of_the_one_before(method: Make, junction: Junction) -> None:
    made = method()
    near = junction.world(car("CAV1", "south-north", 66.0, 8.0), car("CAV2", "west-east", 64.0, 8.0))
    tied = junction.world(car("CAV1", "south-north", 58.0, 8.0), car("CAV2", "west-east", 64.0, 8.0))
    made.act(near)
    made.reset(junction.road_map, junction.model, 0)
    assert made.act(tied).as_dict() == method().act(tied).as_dict()


def test_what_was_asked_in_a_step_that_broke_off_is_accounted_for(junction: Junction) -> None:
    def script(question: Question) -> str | Exception:
        if question.purpose == "decide":
            return ModelUnavailableError("the server said 503, asked 3 times")
        return "no order"

    asked = reasoned(junction, script)
    asked.method._ledger = asked.ledger
    world = junction.world(car("CAV1", "south-north", 70.0, 8.0), car("CAV2", "west-east", 70.0, 8.0))
    with pytest.raises(ModelUnavailableError):
        asked.method.act(world)
    counts, lines = asked.method.unfinished_step(1.5)
    assert counts["model_calls"] == len(asked.chat.questions) - 1 == 2
    assert [(line["purpose"], line["time"]) for line in lines] == [("negotiate", 1.5)]
    assert asked.method.unfinished_step(2.0)[1] == []
