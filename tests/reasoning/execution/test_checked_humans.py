"""How executors and the pipeline take human drivers: the table of docs/methods/README.md, moment by moment."""

from collections.abc import Callable, Mapping
from itertools import product
from typing import Any

import pytest
from driven import drive, ordered, planned
from worlds import FULL, Car, Junction, car

from codriving.config.build import build, validate
from codriving.config.compose import compose
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment
from codriving.errors import ConfigError
from codriving.llm.language_model import Offline
from codriving.methods.codriving import CoDriving
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.methods.mcts import MonteCarloTreeSearch
from codriving.methods.ordered import Ordered
from codriving.reasoning.execution.planned import Humans
from codriving.reasoning.ordering.protocol import OrderRule
from codriving.reasoning.sharing.sharing import CdaLevel
from codriving.runs.json_files import lines_text

Make = Callable[..., Environment]

EQUAL: Mapping[str, float] = {"margin": 1.5, "gap": 1.0, "pad": 0.0, "headway": 0.8}
"""The margins between CAVs with which `codriving` drives."""


def pipeline(junction: Junction, rule: OrderRule | None = None) -> CoDriving:
    made = CoDriving(CdaLevel(**FULL), Offline(), None, 1.5, rule or FirstComeFirstServed())
    made.reset(junction.road_map, junction.model, 0)
    return made


def what_is_left(junction: Junction, who: str, *cars: Car) -> tuple[str, dict[str, float | None]]:
    """The action of CAV1 and how far it gets after each action along the lane [m]; None for one that is removed."""
    executors = {"planned": planned(), "checked": planned(humans="checked", **EQUAL)}
    made = ordered(junction, executor=executors[who]) if who in executors else pipeline(junction)
    deliberation = made.act(junction.world(*cars))
    (situation,) = (s for s in deliberation.situations if s.scene.ego.id == "CAV1")
    left = {str(a.action): None if a.reasons or a.progress is None else a.progress for a in situation.assessments}
    rounded = {name: gain if gain is None else round(gain, 1) for name, gain in left.items()}
    return str(deliberation.actions["CAV1"]), rounded


# Columns of the table, first to last: what all agree in is that the CAV drives south to north.
MOMENTS = {
    # A driver who crosses: planned keeps out of all places where it may be, the others arrive 1.5 s after it.
    "plans": (
        (car("CAV1", "south-north", 80.0, 8.0, 9.0), car("HDV1", "west-east", 74.0, 8.0)),
        ("SLOWER", {"SLOWER": 39.7, "IDLE": 33.2, "FASTER": 33.2}),
        ("FASTER", {"SLOWER": 52.0, "IDLE": 51.0, "FASTER": 51.0}),
    ),
    # A driver who turns left before the CAV: planned keeps clear of it, whichever of the two goes first.
    "first": (
        (car("CAV1", "south-north", 88.0, 8.0, 9.0), car("HDV1", "north-east", 100.0, 6.0)),
        ("SLOWER", {"SLOWER": 55.1, "IDLE": 51.6, "FASTER": 51.6}),
        ("FASTER", {"SLOWER": 68.0, "IDLE": 67.8, "FASTER": 67.8}),
    ),
    # A driver 9 m ahead at the same speed: what if it brakes as hard as it can?
    "ahead": (
        (car("CAV1", "south-north", 40.0, 9.0, 9.0), car("HDV1", "south-north", 54.0, 9.0)),
        ("FASTER", {"SLOWER": 70.8, "IDLE": 70.9, "FASTER": 70.9}),
        ("SLOWER", {"SLOWER": 75.0, "IDLE": None, "FASTER": None}),
    ),
    # A driver 1 m behind at the same speed: planned does not mind it.
    "behind": (
        (car("CAV1", "south-north", 50.0, 9.0, 9.0), car("HDV1", "south-north", 44.0, 9.0)),
        ("FASTER", {"SLOWER": 75.0, "IDLE": 76.5, "FASTER": 76.5}),
        ("FASTER", {"SLOWER": None, "IDLE": 76.5, "FASTER": 76.5}),
    ),
}


@pytest.mark.parametrize("moment", MOMENTS)
def test_what_each_forbids_in_a_moment(moment: str, junction: Junction) -> None:
    cars, by_place, by_check = MOMENTS[moment]
    assert what_is_left(junction, "planned", *cars) == by_place
    assert what_is_left(junction, "checked", *cars) == by_check
    assert what_is_left(junction, "codriving", *cars) == by_check


@pytest.mark.parametrize(
    ("suite", "rule"), [*product(["paper", "default"], [FirstComeFirstServed, MonteCarloTreeSearch])]
)
def test_with_the_same_margins_the_executor_decides_as_the_pipeline(
    suite: str, rule: type[OrderRule], configured: Make
) -> None:
    environment = configured(f"suite={suite}", "scenario.hdvs=[3,3]")
    checked = Ordered(rule(), planned(humans="checked", **EQUAL))
    theirs = CoDriving(CdaLevel(**FULL), Offline(), None, 1.5, rule())
    world = environment.reset(10_012)
    for method in (checked, theirs):
        method.reset(environment.road_map, environment.driving_model, 0)
    taken: set[Action] = set()
    for _ in range(8):
        ours, plain = checked.act(world), theirs.act(world)
        assert ours.actions == plain.actions
        taken |= set(ours.actions.values())
        for mine, other in zip(ours.situations, plain.situations, strict=True):
            removed = [{a.action for a in s.assessments if not a.safe} for s in (mine, other)]
            assert removed[0] >= removed[1] - {Action.LANE_LEFT, Action.LANE_RIGHT}
        world = environment.step(plain.actions)
    assert len(taken) > 1


def written(environment: Environment, humans: Humans) -> str:
    steps = drive(environment, Ordered(FirstComeFirstServed(), planned(humans=humans)), 10_005, decisions=8).steps
    return lines_text("", [step.as_dict() for step in steps])


def test_without_human_drivers_the_setting_makes_no_difference(configured: Make) -> None:
    environment = configured("suite=default", "scenario.hdvs=[0,0]")
    assert written(environment, "planned") == written(environment, "checked")


def test_the_same_seed_gives_the_same_bytes(configured: Make) -> None:
    environment = configured("suite=default")
    assert written(environment, "checked") == written(environment, "checked") != written(environment, "planned")


def test_a_plan_keeps_the_margin_behind_a_driver_who_goes_first(junction: Junction) -> None:
    cars = (car("CAV1", "south-north", 80.0, 8.0, 9.0), car("HDV1", "west-east", 74.0, 8.0))
    gains = []
    for margin in (0.6, 1.5, 3.0):
        made = ordered(junction, executor=planned(humans="checked", human_margin=margin))
        (situation,) = made.act(junction.world(*cars)).situations
        gains.append(max(a.progress for a in situation.assessments if a.progress is not None))
    assert gains[0] > gains[1] > gains[2]


def test_what_is_removed_is_said_in_the_words_of_the_safety_check(junction: Junction) -> None:
    cars, *_ = MOMENTS["ahead"]
    (situation,) = ordered(junction, executor=planned(humans="checked")).act(junction.world(*cars)).situations
    (faster,) = (a for a in situation.assessments if a.action is Action.FASTER)
    assert faster.reasons == ("same lane: FASTER leaves too little room to stop behind HDV1 at 9.0 m/s",)
    assert not faster.safe


@pytest.mark.parametrize(
    ("tokens", "said"),
    [
        (["executor.humans=trusted"], "executor.humans must be one of planned, checked, got 'trusted'"),
        (["executor.human_margin=6"], "executor.human_margin must be 0 to 5, got 6"),
        (
            ["executor=layered", "executor.humans=checked"],
            "unknown key executor.humans; it is a key of executor=planned",
        ),
    ],
)
def test_what_cannot_be_set_is_refused(tokens: list[str], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        validate(compose(tokens))


def test_names_for_tables() -> None:
    made: Any = build(compose(["method=fcfs", "executor.humans=checked"])["method"], Ordered, "method")
    assert (made.name, made.variant) == ("fcfs", "humans=checked")
