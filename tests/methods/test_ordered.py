"""Methods that order: what they are called, what they write down, and that they see the world and nothing else."""

import json
from collections.abc import Callable, Sequence
from dataclasses import fields, is_dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from driven import Episode, configured_executor, drive, layered, ordered, ordering_of, planned
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Junction, car

from codriving.animation.content import deliberated
from codriving.animation.film import EpisodeFilm
from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.order import Instance
from codriving.datatypes.record import Ending, EpisodeRecord, Outcome
from codriving.datatypes.world import Action, WorldState
from codriving.environment.environment import Environment
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.methods.ordered import Ordered
from codriving.reasoning.execution.planned import Planned
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering, OrderRule, Request, in_order
from codriving.reasoning.ordering.schedule import repaired, timed
from codriving.runs.json_files import lines_text

Make = Callable[..., Environment]
SCENARIOS = ("intersection", "roundabout", "highway", "merge")
RULES = ("fcfs", "idfst", "mcts")
DECISIONS = 4
ROUTES = tuple(
    f"{a}-{b}" for a in ("south", "west", "north", "east") for b in ("south", "west", "north", "east") if a != b
)


class InOrderOfNames(OrderRule):
    """A rule of the simplest kind, which writes down what it was handed."""

    name, variant = "names", ""

    def __init__(self, backwards: bool = False) -> None:
        self.backwards, self.seeds, self.posed = backwards, [], []  # type: tuple[bool, list[int], list[Instance]]

    def reset(self, seed: int) -> None:
        """Note the seed."""
        self.seeds.append(seed)
        self.posed.clear()

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """By name."""
        self.posed.append(instance)
        names = repaired(instance, sorted(instance.vehicles, reverse=self.backwards))
        return Ordering(tuple(names), timed(instance, names), counts={"tried": 1})

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        """The first come."""
        return in_order(requests)


def method(name: str, *overrides: str) -> Ordered:
    made = build(compose([f"method={name}", *overrides])["method"], object)
    assert isinstance(made, Ordered)
    return made


@pytest.mark.parametrize(
    ("tokens", "variant"),
    [
        ((), ""),
        (("executor=planned",), ""),
        (("executor=layered",), "layered"),
        (("method.rule.mode=global",), "global"),
        (("method.rule.mode=global", "executor=layered"), "global/layered"),
    ],
)
def test_names_for_tables(tokens: tuple[str, ...], variant: str) -> None:
    made = method("fcfs", *tokens)
    assert (made.name, made.variant, made.reasoner) == ("fcfs", variant, "none")


def few(environment: Environment, made: Ordered, seed: int = 10_007) -> Episode:
    return drive(environment, made, seed, decisions=DECISIONS)


@pytest.fixture(scope="module")
def driven(configured: Make) -> Callable[..., Episode]:
    """The first decisions of each method on each road, driven once."""

    @cache
    def once(scenario: str, name: str, executor: str = "planned") -> Episode:
        return few(configured(f"scenario={scenario}"), method(name, f"executor={executor}"))

    return once


@pytest.mark.parametrize(("name", "executor"), [*((name, "planned") for name in RULES), ("fcfs", "layered")])
@pytest.mark.parametrize("scenario", SCENARIOS)
def test_the_same_seed_gives_the_same_bytes(
    scenario: str, name: str, executor: str, configured: Make, driven: Callable[..., Episode]
) -> None:
    environment, used = configured(f"scenario={scenario}"), method(name, f"executor={executor}")
    drive(environment, used, 10_008, decisions=3)
    episodes = few(environment, used), driven(scenario, name, executor)
    written = [lines_text("", [step.as_dict() for step in episode.steps]) for episode in episodes]
    assert written[0] == written[1], "nothing is left of the episode before"
    assert written[0].count("\n") == DECISIONS


@pytest.mark.parametrize("scenario", SCENARIOS)
def test_a_line_is_strict_json_and_has_all_that_a_line_has(scenario: str, driven: Callable[..., Episode]) -> None:
    for step in driven(scenario, "idfst").steps:
        line = step.as_dict()
        assert json.loads(json.dumps(line, allow_nan=False)) == line
        assert json.loads(lines_text("", [line])) == line
        for cav, decision in zip(line["cavs"], step.decisions, strict=True):
            assert (cav["id"], cav["action"], cav["reason"]) == (decision.ego, decision.action, decision.reason)
            assert cav["reason"]
            assert cav["order"]["binding"] is True
            assert set(cav["allowed"]) | set(cav["removed"]) == {a["action"] for a in cav["assessments"]}
            assert all(cav["removed"].values()), "whatever is removed has a reason"
            assert all(len(p["reason"]) > 5 for p in cav["order"]["precedences"])


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.tuples(st.sampled_from(ROUTES), st.floats(20.0, 112.0), st.floats(0.0, 9.0)), min_size=1, max_size=6),
    st.lists(st.tuples(st.sampled_from(ROUTES), st.floats(20.0, 112.0), st.floats(0.0, 9.0)), max_size=3),
    st.booleans(),
)
def test_what_is_agreed_is_the_order_of_the_rule_and_respects_what_is_fixed(
    junction: Junction, some: list[tuple[str, float, float]], others: list[tuple[str, float, float]], backwards: bool
) -> None:
    cars = [car(f"CAV{k}", *c) for k, c in enumerate(some)] + [car(f"HDV{k}", *c) for k, c in enumerate(others)]
    rule = InOrderOfNames(backwards)
    world = junction.world(*cars)
    deliberation = ordered(junction, rule).act(world)
    (instance,) = rule.posed
    assert len({id(s.order) for s in deliberation.situations}) <= 1, "all are told the same"
    names = [s.scene.ego.id for s in deliberation.situations]
    assert names == [d.ego for d in deliberation.decisions] == sorted(world.available)
    assert all(d.action in world.available[d.ego] for d in deliberation.decisions)
    order = deliberation.situations[0].order
    ranked = repaired(instance, sorted(instance.vehicles, reverse=backwards))
    between = [(p.first, p.second) for p in order.precedences if {p.first, p.second} <= instance.vehicles.keys()]
    assert all(ranked.index(a) < ranked.index(b) for a, b in between)
    for one, other in instance.before:
        if (other, one) not in instance.before and set(between) & {(one, other), (other, one)}:
            # Where what is fixed forms a circle, as only vehicles that collide anyway can, a vehicle has to go first.
            assert (one, other) in between or len(instance.before) > 2
    assert deliberation.counts["tried"] == 1


@pytest.mark.parametrize("make", [planned, layered])
def test_the_rule_and_nothing_else_decides_who_goes_first(make: Callable[[], Any], junction: Junction) -> None:
    world = junction.world(car("CAV1", "south-north", 80.0, 8.0), car("CAV2", "west-east", 80.0, 8.0))
    for backwards, first in ((False, "CAV1"), (True, "CAV2")):
        deliberation = ordered(junction, InOrderOfNames(backwards), make()).act(world)
        assert [p.first for p in deliberation.situations[0].order.precedences] == [first]
        second = "CAV2" if first == "CAV1" else "CAV1"
        assert deliberation.actions[first] is Action.FASTER
        assert deliberation.actions[second] is not Action.FASTER


def test_an_episode_begins_with_the_seed_and_without_a_past(junction: Junction) -> None:
    class Notes(Planned):
        resets = 0

        def reset(self) -> None:
            super().reset()
            self.resets += 1

    rule, executor = InOrderOfNames(), Notes(**configured_executor("planned"))
    made = ordered(junction, rule, executor, seed=3)
    before = executor.resets
    made.act(junction.world(car("CAV1", "south-north", 80.0, 8.0), car("CAV2", "west-east", 80.0, 8.0)))
    made.reset(junction.road_map, junction.model, 4)
    assert (rule.seeds, rule.posed) == ([3, 4], [])
    assert executor.resets == before + 1


def kinds(value: object, found: set[str]) -> set[str]:
    """The packages of all that a value holds."""
    found.add(type(value).__module__)
    if is_dataclass(value):
        for field in fields(value):
            kinds(getattr(value, field.name), found)
    elif isinstance(value, dict):
        for item in (*value, *value.values()):
            kinds(item, found)
    elif isinstance(value, tuple | list):
        for item in value:
            kinds(item, found)
    return found


def test_it_is_handed_the_world_and_nothing_of_the_simulator(configured: Make) -> None:
    environment = configured("scenario=intersection")
    rule = InOrderOfNames()
    made = Ordered(rule, planned())
    made.reset(environment.road_map, environment.driving_model, 0)
    seen: list[WorldState] = [environment.reset(10_000)]
    for _ in range(3):
        seen.append(environment.step(made.act(seen[-1]).actions))
    assert all(
        module.startswith("codriving.datatypes") or module in {"builtins", "enum", "types"}
        for module in kinds(seen, set())
    )
    # The same world without a simulator behind it is answered alike.
    again = Ordered(InOrderOfNames(), planned())
    again.reset(environment.road_map, environment.driving_model, 0)
    other = Ordered(InOrderOfNames(), planned())
    other.reset(environment.road_map, environment.driving_model, 0)
    copies = [WorldState(w.time, w.step, tuple(w.vehicles), dict(w.intents), dict(w.available)) for w in seen]
    assert [again.act(w).as_dict() for w in seen] == [other.act(w).as_dict() for w in copies]


def test_the_true_route_of_a_human_driver_is_known_to_no_rule(junction: Junction) -> None:
    lines = []
    for route in ("west-north", "west-east", "west-south"):
        world = junction.world(car("CAV1", "south-north", 85.0, 7.0), car("HDV1", route, 85.0, 7.0))
        lines.append(ordered(junction).act(world).as_dict())
    assert lines[0] == lines[1] == lines[2]


def test_a_world_without_cavs_asks_for_nothing(junction: Junction) -> None:
    for executor in (planned(), layered()):
        made = ordered(junction, executor=executor)
        assert made.act(junction.world(car("HDV1", "south-north", 60.0, 7.0))).actions == {}
        assert made.act(junction.world()).as_dict()["cavs"] == []


def test_a_slow_driver_is_overtaken_if_the_rule_grants_it(highway: Junction) -> None:
    class Refuses(FirstComeFirstServed):
        def grant(self, requests: object) -> frozenset[str]:
            return frozenset()

    cars = car("CAV1", "lane-1", 300.0, 25.0), car("HDV1", "lane-1", 335.0, 15.0)
    granted = ordered(highway).act(highway.world(*cars)).decisions[0]
    refused = ordered(highway, Refuses()).act(highway.world(*cars)).decisions[0]
    assert granted.action in (Action.LANE_LEFT, Action.LANE_RIGHT)
    assert "granted" in granted.reason
    assert refused.action not in (Action.LANE_LEFT, Action.LANE_RIGHT)


@pytest.mark.parametrize("name", ["fcfs", "coop_game_fuzzy"])
@pytest.mark.parametrize("scenario", ["intersection", "highway"])
def test_its_episodes_can_be_drawn(scenario: str, name: str, configured: Make, driven: Callable[..., Episode]) -> None:
    environment, episode = configured(f"scenario={scenario}"), driven(scenario, name)
    lines = [json.loads(text) for text in lines_text("", [s.as_dict() for s in episode.steps]).splitlines()]
    read = [deliberated(line, environment.road_map) for line in lines]
    for step, shown in zip(episode.steps, read, strict=True):
        assert {n: t.action for n, t in shown.thoughts.items()} == step.actions
        expected = step.situations[0].order.sequence
        assert shown.order == (expected or None)
        assert ("binding" in shown.order_title) is bool(expected)
        met = {frozenset((c.ego, c.other)) for s in step.situations for c in s.conflicts}
        assert {frozenset((m.one, m.other)) for m in shown.meetings} == met
    outcome = Outcome(Ending.TIMEOUT, DECISIONS * 0.5, {})
    record = EpisodeRecord(scenario, name, "full", "none", 10_007, outcome, None, (), DECISIONS, {})
    shown_film = EpisodeFilm(environment.scenario.road, episode.trajectory, lines, record)
    frames = [frame.copy() for frame in shown_film.frames(Fraction(1), 1.0)]
    assert frames
    assert any((frame != frames[0]).any() for frame in frames[1:])


def test_its_rule_is_told_where_the_ordering_comes_from(junction: Junction) -> None:
    # Reasons of the rule reach the order that is told; what it is silent about is still said in a sentence.
    class Says(InOrderOfNames):
        def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
            assert planner.plan(sorted(instance.vehicles)).feasible
            return Ordering(*_names("CAV1", "CAV2", "CAV3"), reasons={("CAV1", "CAV2"): "because I say so"})

    world = junction.world(
        car("CAV1", "south-north", 70.0, 8.0), car("CAV2", "west-east", 70.0, 8.0), car("CAV3", "east-west", 70.0, 8.0)
    )
    order = ordered(junction, Says()).act(world).situations[0].order
    said = {(p.first, p.second): p.reason for p in order.precedences}
    assert said["CAV1", "CAV2"] == "because I say so"
    assert "CAV3" in said["CAV1", "CAV3"]


def _names(*sequence: str) -> tuple[tuple[str, ...], dict[str, float]]:
    given_order = ordering_of(*sequence)
    return given_order.sequence, dict(given_order.times)
