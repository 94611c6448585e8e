"""Which moments are kept, and what is noted of them."""

import json
from collections.abc import Sequence

import pytest
from dilu_driven import NEVER_HELD, Notebook, always, modelled, ruled, text
from worlds import Junction, car

from codriving.datatypes.experience import Experience, Verdict
from codriving.datatypes.record import Collision, Ending, Outcome
from codriving.datatypes.situation import Decision, Situation
from codriving.datatypes.world import Action, WorldState
from codriving.methods.dilu.collision_log import CollisionLog
from codriving.methods.dilu.dilu import DiLu, describe_alone
from codriving.methods.dilu.rule import correct_by_rule
from codriving.methods.single_vehicle.demonstrated import CONSTANT
from codriving.reasoning.perception import single_vehicle_perception
from codriving.reasoning.prediction.forecast import Forecast

CRASH = Collision(3.2, "CAV1", "HDV1", "CAV-HDV")
CRASHED = Outcome(Ending.COLLISION, 3.2, {}, CRASH)
ARRIVED = Outcome(Ending.SUCCESS, 9.0, {"CAV1": 9.0})


@pytest.fixture(scope="module")
def told(junction: Junction) -> Situation:
    """What CAV1 is told of HDV1, who comes from the left."""
    perception = single_vehicle_perception(junction.road_map, Forecast(junction.model, CONSTANT))
    world = junction.world(car("CAV1", "south-north", 86, 8, 9), car("HDV1", "west-east", 85, 8))
    return describe_alone(perception.perceive(world), "CAV1")


def logged(told: Situation, actions: Sequence[Action], ego: str = "CAV1") -> CollisionLog:
    made = CollisionLog(correct_by_rule)
    for k, action in enumerate(actions):
        note(made, k, told, Decision(ego, action, "HDV1 is far"))
    return made


def note(log: CollisionLog, k: int, told: Situation, decision: Decision) -> None:
    """Note one decision a second, each two steps after the last."""
    log.note(WorldState(float(k), 2 * k, (), {}, {}), [told], [decision])


def kept(log: CollisionLog, outcome: Outcome) -> list[Experience]:
    """What is remembered of an episode."""
    return log.conclude(WorldState(0.0, 0, (), {}, {}), outcome)


def test_mistake_is_the_last_decision_before_the_collision_that_was_not_to_slow_down(told: Situation) -> None:
    actions = [Action.FASTER, Action.IDLE, Action.FASTER, Action.SLOWER, Action.FASTER]
    (mistake,) = logged(told, actions).mistakes(CRASH)
    assert (mistake.step, mistake.decision.action, mistake.other, mistake.struck) == (4, Action.FASTER, "HDV1", True)
    assert mistake.later == pytest.approx(1.2)


def test_a_vehicle_that_slowed_down_all_along_made_no_mistake(told: Situation) -> None:
    assert kept(logged(told, [Action.SLOWER] * 4), CRASHED) == []


def test_both_cavs_of_a_collision_made_one(told: Situation) -> None:
    made = logged(told, [Action.FASTER])
    note(made, 1, told, Decision("CAV2", Action.LANE_LEFT, ""))
    mistakes = made.mistakes(Collision(2.0, "CAV1", "CAV2", "CAV-CAV"))
    assert [(m.decision.ego, m.other, m.struck) for m in mistakes] == [("CAV1", "CAV2", True), ("CAV2", "CAV1", False)]
    right = [c.action for c in correct_by_rule(mistakes)]
    assert right == [Action.SLOWER, Action.IDLE]


def test_correction_by_rule_is_remembered(told: Situation) -> None:
    (learnt,) = kept(logged(told, [Action.FASTER, Action.IDLE]), CRASHED)
    assert (learnt.action, learnt.verdict, learnt.step, learnt.effect.collision) == (
        Action.IDLE,
        Verdict.INTENSIFIED,
        2,
        pytest.approx(2.2),
    )
    assert learnt.lesson == (
        "Mistake: IDLE, and 2.2 s later you ran into another vehicle. "
        "Lesson: Slow down in time in a situation like this. Right: SLOWER."
    )
    assert learnt.description.kinds["driver"] == "unknown"
    assert learnt.description.kinds["order"] == "none"


def test_of_a_success_every_fifth_decision_is_kept(told: Situation) -> None:
    learnt = kept(logged(told, [Action.FASTER] * 12), ARRIVED)
    assert [(e.step, e.verdict) for e in learnt] == [(8, Verdict.EASED), (18, Verdict.EASED)]
    assert learnt[0].lesson == "No mistake, the drive ended well. Why: another vehicle is far"


@pytest.mark.parametrize("ending", [Ending.TIMEOUT, Ending.OFF_ROAD])
def test_of_anything_else_nothing_is_kept(told: Situation, ending: Ending) -> None:
    assert kept(logged(told, [Action.FASTER] * 12), Outcome(ending, 50.0, {})) == []


def crashing(junction: Junction, made: DiLu) -> tuple[dict[str, float], list[dict[str, object]]]:
    """Decide once, and then say that CAV1 has run into HDV1."""
    world = junction.world(car("CAV1", "south-north", 86, 8, 9), car("HDV1", "west-east", 85, 8))
    made.act(world)
    return made.conclude(world, CRASHED)


def test_model_reflects_once_on_a_mistake(junction: Junction) -> None:
    book = Notebook()
    made, chat = modelled(junction, always("FASTER"), book, NEVER_HELD)
    counts, lines = crashing(junction, made)
    assert [q.purpose for q in chat.questions] == ["decide", "reflect"]
    assert "What you did: FASTER. Your reason: it is free" in text(chat.questions[1])
    assert "3.2 s later you ran into V1." in text(chat.questions[1])
    assert [line["purpose"] for line in lines] == ["reflect"]
    assert (counts["experiences"], counts["experiences_new"], counts["fallbacks"]) == (1, 1, 0)
    [kept] = book.learnt
    assert kept.lesson == "Mistake: another vehicle was overlooked. Lesson: Let them pass. Right: SLOWER."


def test_a_lesson_of_the_form_is_that_of_the_rule_and_counted(junction: Junction) -> None:
    book = Notebook()
    said = json.dumps({"mistake": "one short sentence", "lesson": "One short sentence.", "action": "SLOWER"})
    made, _ = modelled(junction, lambda q: said if q.purpose == "reflect" else always("FASTER")(q), book, NEVER_HELD)
    counts, _ = crashing(junction, made)
    assert (counts["lessons_dropped"], counts["fallbacks"]) == (1, 0)
    assert "hort sentence" not in book.learnt[0].lesson
    assert "FASTER, and 3.2 s later you ran into another vehicle. Lesson: Slow down in time" in book.learnt[0].lesson


@pytest.mark.parametrize("said", ["no idea", {"lesson": "x", "action": "FASTER"}, {"lesson": "", "action": "SLOWER"}])
def test_reflection_that_cannot_be_used_is_written_by_rule_and_counted(junction: Junction, said: object) -> None:
    book = Notebook()
    answer = json.dumps(said)
    made, _ = modelled(junction, lambda q: answer if q.purpose == "reflect" else always("FASTER")(q), book, NEVER_HELD)
    counts, _ = crashing(junction, made)
    assert (counts["fallbacks"], counts["re_asks"]) == (1, 1)
    assert "Slow down in time" in book.learnt[0].lesson


def test_rule_reflects_without_a_model_and_only_if_there_is_something_to_learn_into(junction: Junction) -> None:
    book = Notebook()
    counts, lines = crashing(junction, ruled(junction, book))
    assert (counts, lines) == ({"experiences": len(book.learnt), "experiences_new": len(book.learnt)}, [])
    assert crashing(junction, ruled(junction, Notebook(learns=False))) == ({}, [])
    assert crashing(junction, ruled(junction)) == ({}, [])


def test_the_templates_of_reflection_count_where_a_memory_learns(junction: Junction) -> None:
    road = junction.road_map.road
    learning, _ = modelled(junction, always("IDLE"), Notebook())
    forgetful, _ = modelled(junction, always("IDLE"))
    assert any("dilu_reflect" in name for name in learning.files(road, True))
    assert not any("reflect" in name for name in forgetful.files(road, True))
