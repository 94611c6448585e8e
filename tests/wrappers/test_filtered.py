"""The safety check behind any method: what becomes of its actions, and what is kept of that."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from driven import configured_executor, drive, planned
from worlds import FULL, Junction, car

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.config.locate import conf_dir
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.parts import Account, Method, RuleModel, Shares
from codriving.datatypes.record import Ending, Outcome
from codriving.datatypes.road import Road
from codriving.datatypes.situation import Decision, Deliberation, ReasonedDeliberation
from codriving.datatypes.world import Action, Manner, WorldState
from codriving.environment.environment import Environment
from codriving.methods.codriving import CoDriving
from codriving.methods.coop_game_fuzzy.coop_game_fuzzy import JointActions
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.methods.idm import Idm
from codriving.methods.ordered import Ordered
from codriving.reasoning.execution.planned import Planned
from codriving.reasoning.sharing.sharing import CdaLevel
from codriving.wrappers.filtered import Filtered, FilteredDeliberation, SafetyFilter

FILTER = SafetyFilter(CdaLevel(**FULL), 1.5)

UNCHECKED = {**FULL, "safety_check": False}

# CAV1 comes too fast to a vehicle that stands 15 m ahead of it, and another one is far from all others.
CARS = (
    car("CAV1", "south-north", 70.0, 8.0, 9.0),
    car("CAV2", "west-east", 20.0, 6.0),
    car("HDV1", "south-north", 90, 0),
)


class Steady(Method):
    """Every CAV wants the same; it notes what else it is asked."""

    name, variant, reasoner, remembers, most_cavs, knows_drivers = "steady", "of mine", "rules", "some", 9, True

    def __init__(self, action: Action) -> None:
        self.action = action
        self.asked: list[object] = []

    def check_road(self, road: Road, target_speeds: Sequence[float], decision_interval: float) -> None:
        self.asked.append(("road", decision_interval))

    def files(self, road: Road, limited: bool) -> Mapping[str, Path]:
        return {"weights": Path("mine")}

    def remark(self, road: Road, world: Mapping[str, str]) -> str:
        return "Mine."

    def reset(self, *given: object) -> None:
        self.asked.append(("seed", given[2]))

    def be_told(self, manners: Mapping[str, Manner]) -> None:
        self.asked.append(("told", manners))

    def act(self, world: WorldState) -> Deliberation:
        decisions = tuple(Decision(cav.id, self.action, "I like it") for cav in world.cavs)
        return Plain(world.time, world.step, (), decisions, {"liked": 2}, ({"asked": 1},))

    def conclude(self, world: WorldState, outcome: Outcome) -> Account:
        return {"learnt": 1}, []

    def unfinished_step(self, time: float) -> Account:
        return {"paid": 1}, []


class Plain(ReasonedDeliberation):
    """Says of each CAV no more than what it does."""

    def as_dict(self) -> dict[str, Any]:
        return {"cavs": [{"id": d.ego, "action": str(d.action), "reason": d.reason} for d in self.decisions]}


def checked(junction: Junction, method: Method, *cars: Any) -> FilteredDeliberation:
    """What becomes of the actions of a method in a world made by hand."""
    filtered = FILTER.around(method)
    assert isinstance(filtered, Filtered)
    filtered.reset(junction.road_map, junction.model, 3)
    return filtered.act(junction.world(*(cars or CARS)))


def test_what_was_wanted_what_was_taken_and_why_is_kept(junction: Junction) -> None:
    deliberation = checked(junction, Steady(Action.FASTER))
    assert deliberation.actions == {"CAV1": Action.SLOWER, "CAV2": Action.FASTER}
    assert deliberation.counts == {"liked": 2, "checked": 2, "replaced": 1}
    assert deliberation.transcript == ({"asked": 1},)
    first, second = deliberation.as_dict()["cavs"]
    assert first["action"] == "SLOWER"
    assert first["reason"] == "SLOWER in the place of FASTER, which the safety check removed; FASTER since: I like it"
    assert (first["filter"]["wanted"], first["filter"]["taken"]) == ("FASTER", "SLOWER")
    (why,) = first["filter"]["removed"]["FASTER"]
    assert why == "same lane: FASTER leaves too little room to stop behind HDV1 at 0.0 m/s"
    assert (second["action"], second["reason"]) == ("FASTER", "I like it")
    assert second["filter"] == {"wanted": "FASTER", "taken": "FASTER", "removed": {}}


def test_where_no_action_is_safe_the_least_dangerous_is_taken(junction: Junction) -> None:
    cars = car("CAV1", "south-north", 80.0, 9.0), car("HDV1", "south-north", 90.0, 0.0)
    deliberation = checked(junction, Steady(Action.FASTER), *cars)
    assert deliberation.actions == {"CAV1": Action.SLOWER}
    assert deliberation.as_dict()["cavs"][0]["filter"]["removed"].keys() == {"IDLE", "FASTER"}


def test_all_else_is_the_methods_own(junction: Junction) -> None:
    method = Steady(Action.IDLE)
    filtered = FILTER.around(method)
    road = junction.road_map.road
    filtered.check_road(road, (0.0, 9.0), 0.5)
    filtered.reset(junction.road_map, junction.model, 7)
    filtered.be_told({})
    assert method.asked == [("road", 0.5), ("seed", 7), ("told", {})]
    assert (filtered.name, filtered.variant, filtered.reasoner) == ("steady", "of mine filtered", "rules")
    assert (filtered.remembers, filtered.most_cavs, filtered.knows_drivers) == ("some", 9, True)
    assert (filtered.remark(road, {}), filtered.files(road, True)) == ("Mine.", {"weights": Path("mine")})
    assert filtered.conclude(junction.world(*CARS), Outcome) == ({"learnt": 1}, [])  # type: ignore[arg-type]
    assert filtered.unfinished_step(1.0) == ({"paid": 1}, [])
    assert filtered.is_checked
    assert filtered.ask_once(junction.world(*CARS)).actions.keys() == {"CAV1", "CAV2"}


def test_what_the_check_knows_has_to_be_told() -> None:
    alone = SafetyFilter(CdaLevel(**{**FULL, "intent_sharing": False, "negotiation": False}), 1.5)
    assert FILTER.around(Steady(Action.IDLE)).shares == Shares(states=True, intents=True)
    assert alone.around(Steady(Action.IDLE)).shares == Shares(states=True)
    tells = Steady(Action.IDLE)
    tells.shares = Shares(intents=True, orders=True)
    assert alone.around(tells).shares == Shares(states=True, intents=True, orders=True)


def test_methods_with_a_check_or_without_actions_are_left_as_they_are() -> None:
    for method in (Idm(), CoDriving(CdaLevel(**FULL), RuleModel(), None, 1.5)):
        assert FILTER.around(method) is method
    unchecked = FILTER.around(CoDriving(CdaLevel(**UNCHECKED), RuleModel(), None, 1.5))
    assert unchecked.variant == "no_safety_check filtered"


class Backwards(Ordered):
    """Lets the later one of two go first."""

    def act(self, world: WorldState) -> ReasonedDeliberation:
        found = super().act(world)
        order = found.situations[0].order
        turned = tuple(replace(p, first=p.second, second=p.first) for p in order.precedences)
        against = PassingOrder(order.sequence[::-1], turned, True)
        return replace(found, situations=tuple(replace(s, order=against) for s in found.situations))


class BesideOrder(Planned):
    """Drives by no order, although one is shown."""

    orders = False


def test_a_method_that_orders_is_checked_by_its_own_order(junction: Junction) -> None:
    cars = car("CAV1", "south-north", 92.0, 8.0, 9.0), car("CAV2", "west-east", 70.0, 8.0, 9.0)

    def safe(method: Method) -> set[str]:
        return {str(a.action) for a in checked(junction, method, *cars).filtered["CAV1"].assessments if a.safe}

    one_order, by_zone = planned(by_zone=False), planned(by_zone=True)
    assert safe(Ordered(FirstComeFirstServed(), one_order)) == {"SLOWER", "IDLE", "FASTER"}
    assert safe(Backwards(FirstComeFirstServed(), one_order)) == {"SLOWER"}
    # By zone it may pass before the one that precedes it, out of whose way it is in time.
    assert safe(Backwards(FirstComeFirstServed(), by_zone)) == {"SLOWER", "IDLE", "FASTER"}
    # An order by which no CAV drives is none: they are checked by the one that is negotiated.
    unused = BesideOrder(**{**configured_executor("planned"), "by_zone": False})
    assert safe(Backwards(FirstComeFirstServed(), unused)) == {"SLOWER", "IDLE", "FASTER"}
    assert not JointActions.orders


def test_cavs_do_not_wait_for_one_that_the_check_holds_back(configured: Callable[..., Environment]) -> None:
    """By zone, who is earlier in the order lets pass who meant to go before it; if that one may not go, all wait."""
    environment = configured("suite=default", "scenario=roundabout", "scenario.cavs=4", "scenario.hdvs=[0,0]")
    method = build(compose(["method=fcfs"])["method"], Ordered)
    driven = drive(environment, FILTER.around(method), 15004)
    assert driven.outcome is not None
    assert driven.outcome.ending is Ending.SUCCESS


def test_codriving_behind_the_filter_may_do_what_its_own_check_allows(junction: Junction) -> None:
    cars = (*CARS[1:], car("CAV1", "south-north", 60.0, 8.0, 9.0), car("HDV2", "north-east", 60.0, 7.0))
    filtered = checked(junction, CoDriving(CdaLevel(**UNCHECKED), RuleModel(), None, 1.5), *cars)
    whole = CoDriving(CdaLevel(**FULL), RuleModel(), None, 1.5)
    whole.reset(junction.road_map, junction.model, 3)
    allowed = {s.scene.ego.id: s.assessments for s in whole.act(junction.world(*cars)).situations}
    assert {name: found.assessments for name, found in filtered.filtered.items()} == allowed


def test_its_margin_is_that_of_codriving() -> None:
    read = {
        name: yaml.safe_load((conf_dir() / name).read_text("utf-8"))
        for name in ("filter/true.yaml", "method/codriving.yaml")
    }
    assert len({values["margin"] for values in read.values()}) == 1


@pytest.mark.parametrize("action", [Action.SLOWER, Action.IDLE, Action.FASTER])
def test_an_allowed_action_is_never_replaced(action: Action, junction: Junction) -> None:
    deliberation = checked(junction, Steady(action))
    for found in deliberation.filtered.values():
        safe = {a.action for a in found.assessments if a.safe}
        assert found.taken in safe
        assert (found.taken is found.wanted) == (found.wanted in safe)
