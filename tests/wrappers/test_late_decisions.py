"""Decisions that come late: in which step they take effect, what drives meanwhile, and what is dropped."""

import pickle
from copy import deepcopy

import pytest
from thinkers import Wishes
from worlds import FULL, Junction, car

from codriving.datatypes.parts import RuleModel
from codriving.datatypes.situation import ReasonedDeliberation
from codriving.datatypes.world import Action
from codriving.methods.codriving import CoDriving
from codriving.reasoning.sharing.sharing import CdaLevel
from codriving.wrappers.delays import Delays
from codriving.wrappers.late_decisions import reflex
from codriving.wrappers.slow import SlowCoDriving

FREE = (car("CAV1", "south-north", 20.0, 8.0), car("CAV2", "west-east", 20.0, 8.0))
STANDS = car("HDV1", "south-north", 32.0, 0.0)
"""So near that CAV1 must brake at 20 m."""


def slow(junction: Junction, mind: float, wishes: Wishes | None = None) -> SlowCoDriving:
    made = SlowCoDriving(CoDriving(CdaLevel(**FULL), RuleModel(), None, 1.5), Delays(mind, 0.0))
    made.reset(junction.road_map, junction.model, 0)
    if wishes is not None:
        assert made._decider is not None
        made._decider.decider = wishes
    return made


def acts(
    made: SlowCoDriving, junction: Junction, steps: int, cars: tuple[object, ...] = FREE
) -> list[ReasonedDeliberation]:
    return [made.act(junction.world(*cars, time=0.5 * k, step=k)) for k in range(steps)]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("mind", "acted", "asked"),
    [
        (0.5, [1, 2, 3, 4, 5], 6),
        (0.7, [2, 4], 3),  # At the first decision step after it
        (1.0, [2, 4], 3),
        (2.0, [4], 2),
    ],
)
def test_a_decision_takes_effect_when_it_has_been_thought_of(
    mind: float, acted: list[int], asked: int, junction: Junction
) -> None:
    wishes = Wishes(Action.FASTER)
    steps = acts(slow(junction, mind, wishes), junction, 6)
    assert [k for k, step in enumerate(steps) if step.actions["CAV1"] is Action.FASTER] == acted
    assert {step.actions["CAV1"] for k, step in enumerate(steps) if k not in acted} == {Action.IDLE}
    # While a mind thinks no new thought begins.
    assert wishes.asked == [["CAV1", "CAV2"]] * asked
    assert sum(step.counts["late_decisions"] for step in steps) == 2 * len(acted)
    assert sum(step.counts["reflexes"] for step in steps) == 2 * (6 - len(acted))
    assert steps[acted[0]].decisions[0].reason == f"thought of {acted[0] / 2:.1f} s ago: answer 1"
    assert steps[0].decisions[0].reason == "IDLE by reflex, while it thinks"


def test_the_safety_check_is_live_at_each_step(junction: Junction) -> None:
    made, wishes = slow(junction, 2.0), Wishes(Action.FASTER)
    assert made._decider is not None
    made._decider.decider = wishes
    calm = made.act(junction.world(*FREE))
    alarmed = made.act(junction.world(*FREE, STANDS, time=0.5, step=1))
    assert (calm.actions["CAV1"], alarmed.actions["CAV1"]) == (Action.IDLE, Action.SLOWER)
    assert alarmed.actions["CAV2"] is Action.IDLE
    assert alarmed.counts["reflexes"] == 2


def test_a_decision_that_is_not_allowed_any_more_is_dropped_and_counted(junction: Junction) -> None:
    made = slow(junction, 1.0, Wishes(Action.FASTER))
    acts(made, junction, 2)
    late = made.act(junction.world(*FREE, STANDS, time=1.0, step=2))
    assert late.actions == {"CAV1": Action.SLOWER, "CAV2": Action.FASTER}
    assert (late.counts["dropped_decisions"], late.counts["late_decisions"]) == (1, 1)
    why = "SLOWER by reflex: FASTER, thought of 1.0 s ago, is not allowed any more"
    assert late.decisions[0].reason == why


def test_each_cav_has_a_mind_of_its_own(junction: Junction) -> None:
    wishes = Wishes(Action.FASTER)
    made = slow(junction, 1.0, wishes)
    made.act(junction.world(FREE[0]))
    made.act(junction.world(*FREE, time=0.5, step=1))
    made.act(junction.world(*FREE, time=1.0, step=2))
    # CAV1 leaves with its thought, and begins anew when it comes back.
    made.act(junction.world(FREE[1], time=1.5, step=3))
    back = made.act(junction.world(*FREE, time=2.0, step=4))
    assert wishes.asked == [["CAV1"], ["CAV2"], ["CAV1"], ["CAV2"], ["CAV1"]]
    assert back.actions == {"CAV1": Action.IDLE, "CAV2": Action.IDLE}


def test_the_reflex_keeps_the_speed_or_brakes_or_does_what_is_left() -> None:
    assert reflex((Action.SLOWER, Action.IDLE, Action.HOLD, Action.FASTER)) is Action.IDLE
    assert reflex((Action.FASTER, Action.SLOWER, Action.HOLD)) is Action.SLOWER
    assert reflex((Action.FASTER,)) is Action.FASTER


def test_a_new_episode_begins_with_nothing_thought_of(junction: Junction) -> None:
    made = slow(junction, 1.0)
    first = [step.as_dict() for step in acts(made, junction, 4)]
    made.reset(junction.road_map, junction.model, 0)
    assert [step.as_dict() for step in acts(made, junction, 4)] == first


def test_copies_go_on_alike_and_apart(junction: Junction) -> None:
    made = slow(junction, 1.0)
    acts(made, junction, 2)
    twins = [deepcopy(made), pickle.loads(pickle.dumps(made)), made]
    world = junction.world(*FREE, time=1.0, step=2)
    lines = [(twin.act(world).as_dict(), twin.act(junction.world(*FREE, time=1.5, step=3)).as_dict()) for twin in twins]
    assert lines[0] == lines[1] == lines[2]
