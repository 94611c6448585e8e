"""An order rule in the place of the negotiation: what it orders, and that nothing else is another one."""

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import pytest
from asked import Scripted, sensible
from driven import drive
from worlds import FULL, Car, Junction, car

from codriving.config.build import build, validate
from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.parts import CaseMemory, Model
from codriving.datatypes.situation import ReasonedDeliberation
from codriving.environment.environment import Environment
from codriving.errors import ConfigError, EpisodeError
from codriving.llm.language_model import Offline
from codriving.llm.scripted import ScriptedChat
from codriving.methods.codriving import CoDriving
from codriving.reasoning.ordering.negotiation import Negotiation
from codriving.reasoning.ordering.protocol import OrderRule
from codriving.reasoning.perception import Moment
from codriving.reasoning.sharing.sharing import CdaLevel
from codriving.runs.json_files import lines_text

Make = Callable[..., Environment]
NAMED = [name for name in choices("order") if name != "negotiated"]

# Four CAVs that meet one another, and a human driver that meets two of them.
BUSY = (
    car("CAV1", "south-north", 60.0, 8.0, 9.0),
    car("CAV2", "west-east", 62.0, 7.0, 9.0),
    car("CAV3", "north-east", 58.0, 9.0, 9.0),
    car("CAV4", "east-south", 66.0, 6.0, 9.0),
    car("HDV1", "east-west", 50.0, 8.0),
)

# The same CAVs, the slow ones ahead: who is nearest is not who could be there first.
SLOW = (
    car("CAV1", "south-north", 70.0, 3.0, 3.0),
    car("CAV2", "west-east", 66.0, 9.0, 9.0),
    car("CAV3", "north-east", 52.0, 9.0, 9.0),
    car("CAV4", "east-south", 74.0, 0.0, 0.0),
)


@cache
def node(name: str) -> dict[str, Any] | None:
    found: dict[str, Any] | None = compose([f"order={name}"])["order"]
    return found


def rule(name: str) -> OrderRule | None:
    chosen = node(name)
    return None if chosen is None else build(chosen, OrderRule, "order")


def made(world: Junction, name: str, model: Model | None = None, **change: Any) -> CoDriving:
    method = CoDriving(CdaLevel(**{**FULL, **change}), model or Offline(), None, 1.5, rule(name))
    method.reset(world.road_map, world.model, 3)
    return method


def order_of_all(deliberation: ReasonedDeliberation) -> PassingOrder:
    orders = [situation.order for situation in deliberation.situations]
    assert all(order is orders[0] for order in orders), "all CAVs agree"
    return orders[0]


# The sequence of all in BUSY and in SLOW.
GOLDEN = {
    "negotiated": (
        "HDV1 CAV4 CAV2 CAV3 CAV1",
        "CAV1 CAV2 CAV3 CAV4",
    ),
    "fcfs": (
        "HDV1 CAV4 CAV1 CAV3 CAV2",
        "CAV1 CAV4 CAV2 CAV3",
    ),
    "idfst": (
        "HDV1 CAV4 CAV1 CAV3 CAV2",
        "CAV1 CAV4 CAV2 CAV3",
    ),
    "mcts": (
        "HDV1 CAV4 CAV1 CAV3 CAV2",
        "CAV4 CAV3 CAV2 CAV1",
    ),
    "coop_game": (
        "HDV1 CAV4 CAV3 CAV2 CAV1",
        "CAV1 CAV2 CAV3 CAV4",
    ),
    "random": (
        "HDV1 CAV3 CAV1 CAV2 CAV4",
        "CAV3 CAV1 CAV2 CAV4",
    ),
    "optimal": (
        "HDV1 CAV4 CAV1 CAV3 CAV2",
        "CAV4 CAV3 CAV2 CAV1",
    ),
}


@pytest.mark.parametrize("name", ["negotiated", *NAMED])
def test_the_order_of_a_moment(name: str, junction: Junction) -> None:
    found = (order_of_all(made(junction, name).act(junction.world(*cars))).sequence for cars in (BUSY, SLOW))
    assert tuple(" ".join(sequence) for sequence in found) == GOLDEN[name]


class Given(Negotiation):
    """Gives all CAVs an order that is known."""

    def __init__(self, order: PassingOrder) -> None:
        self.order = order

    def orders(self, moment: Moment) -> Mapping[str, PassingOrder]:
        """The same for all."""
        return dict.fromkeys(moment.scenes, self.order)


@pytest.mark.parametrize("cars", [BUSY, SLOW])
@pytest.mark.parametrize("name", NAMED)
def test_the_order_alone_is_another_one(name: str, cars: tuple[Car, ...], junction: Junction) -> None:
    world = junction.world(*cars)
    negotiated, ordered = made(junction, "negotiated"), made(junction, name).act(world)
    plain = negotiated.act(world)
    for ours, theirs in zip(ordered.situations, plain.situations, strict=True):
        assert (ours.scene, ours.conflicts, ours.memories) == (theirs.scene, theirs.conflicts, theirs.memories)
        assert [a.action for a in ours.assessments] == [a.action for a in theirs.assessments]
    # Told the same order, the pipeline with the negotiation expects, checks and decides the same.
    negotiated = made(junction, "negotiated")
    negotiated.pipeline.negotiation = Given(order_of_all(ordered))
    assert negotiated.act(world).as_dict() == ordered.as_dict()


def test_another_order_leads_to_other_actions(junction: Junction) -> None:
    world = junction.world(*BUSY)
    taken = {name: made(junction, name).act(world).actions for name in ("negotiated", "fcfs")}
    assert {name: actions["CAV3"] for name, actions in taken.items()} == {"negotiated": "SLOWER", "fcfs": "FASTER"}


def test_an_order_binds_as_much_as_a_negotiated_one(junction: Junction) -> None:
    world = junction.world(*BUSY)
    for binding in (False, True):
        for name in ("negotiated", "fcfs", "random"):
            assert order_of_all(made(junction, name, binding=binding).act(world)).binding is binding


def test_pairs_with_human_drivers_follow_from_the_schedule_of_the_rule(junction: Junction) -> None:
    for name in ("negotiated", "fcfs", "mcts"):
        order = order_of_all(made(junction, name).act(junction.world(*BUSY)))
        reasons = {p.reason.split(" (")[0] for p in order.precedences if "HDV1" in (p.first, p.second)}
        assert reasons, "the human driver meets some of them"
        assert all("human driver" in reason for reason in reasons)


def few(environment: Environment, method: CoDriving, seed: int) -> list[str]:
    steps = drive(environment, method, seed, decisions=6).steps
    return [lines_text("", [step.as_dict() for step in steps])]


@pytest.mark.parametrize("name", ["fcfs", "random"])
def test_the_same_seed_gives_the_same_bytes_after_another_episode(name: str, configured: Make) -> None:
    environment = configured("suite=default")
    used, new = (CoDriving(CdaLevel(**FULL), Offline(), None, 1.5, rule(name)) for _ in range(2))
    few(environment, used, 10_008)
    assert few(environment, used, 10_007) == few(environment, new, 10_007)


@pytest.mark.parametrize(
    ("tokens", "variant"),
    [
        ([], "full"),
        (["order=fcfs"], "order=fcfs"),
        (["order=fcfs", "order.mode=global"], "order=fcfs/global"),
        (["order=mcts", "cda=prescriptive"], "full/binding/order=mcts"),
        (["order=mcts", "cda.safety_check=false"], "no_safety_check/order=mcts"),
    ],
)
def test_names_for_tables(tokens: list[str], variant: str) -> None:
    method = build(compose(tokens)["method"], CoDriving, "method", given={Model: Offline(), CaseMemory: None})
    assert (method.name, method.variant) == ("codriving", variant)


@pytest.mark.parametrize("level", ["cda=intent_sharing", "cda.negotiation=false"])
def test_there_is_no_place_for_an_order_where_each_cav_has_its_own(level: str) -> None:
    with pytest.raises(ConfigError, match=r"with cda.negotiation=false each CAV .* leave order= out, or choose a cda="):
        validate(compose(["order=fcfs", level]))


@pytest.mark.parametrize(
    ("tokens", "said"),
    [
        (["order=none"], "unknown order 'none'; choices: negotiated, fcfs, idfst, mcts, coop_game, optimal, random"),
        (["order.mode=global"], "order has no _target_, .*; choose one with order=<name> first"),
        (["order=fcfs", "order.mode=each"], "order.mode must be one of conflict, global, reservation"),
        (["order=fcfs", "order.iterations=3"], "unknown key order.iterations; it is a key of order=mcts"),
        (["method.order.mode=global"], "method.order.mode is order itself; set order.mode instead"),
    ],
)
def test_what_cannot_be_chosen_is_refused(tokens: list[str], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        validate(compose(tokens))


def test_the_best_order_of_more_than_ten_is_refused_in_a_line(junction: Junction) -> None:
    routes = ("south-north", "west-east", "north-south", "east-west")
    cars = [car(f"CAV{k:02}", routes[k % 4], 60.0 - 10 * (k // 4), 6.0, 9.0) for k in range(11)]
    with pytest.raises(EpisodeError, match=r"at most 10 vehicles, got 11; take .*order=mcts in the place of"):
        made(junction, "optimal").act(junction.world(*cars))


def test_the_best_order_has_no_place_in_flows() -> None:
    assert (CoDriving(CdaLevel(**FULL), Offline(), None, 1.5, rule("optimal"))).most_cavs == 10
    assert (CoDriving(CdaLevel(**FULL), Offline(), None, 1.5, rule("mcts"))).most_cavs is None


def test_a_rule_is_a_choice_of_order_and_of_a_method_with_the_same_settings() -> None:
    for order, method in (
        ("optimal", "bruteforce"),
        *((name, name) for name in ("fcfs", "idfst", "mcts", "coop_game")),
    ):
        assert node(order) == compose([f"method={method}"])["method"]["rule"]


def test_a_model_decides_and_is_not_asked_for_an_order(junction: Junction) -> None:
    world = junction.world(*BUSY)
    for name, purposes in (("negotiated", {"negotiate", "decide"}), ("fcfs", {"decide"})):
        model = Scripted(ScriptedChat(sensible))
        method = made(junction, name, model)
        order = order_of_all(method.act(world))
        assert {question.purpose for question in model.scripted.questions} == purposes
        assert set(method.asked) == purposes
    assert order == order_of_all(made(junction, "fcfs").act(world)), "by rules or by a model, it is the rule's order"
