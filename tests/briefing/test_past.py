"""What a CAV is told of its last decision, and of what has changed since, each bound on both sides."""

from dataclasses import replace

import pytest
from asked import reasoned, sensible
from worlds import Junction, car

from codriving.briefing.past import PastDecisions
from codriving.datatypes.order import PassingOrder, Precedence
from codriving.datatypes.situation import Decision, Situation
from codriving.datatypes.world import Action

CAV = car("CAV1", "south-north", 80, 8, 9)
OTHERS = car("CAV2", "west-east", 82, 8, 9), car("HDV1", "east-south", 76, 8)
DECIDED = Decision("CAV1", Action.SLOWER, "CAV2 goes first")


@pytest.fixture(scope="module")
def met(junction: Junction) -> Situation:
    """What CAV1 is told in conflict with a CAV and a human driver."""
    return reasoned(junction, sensible).method.act(junction.world(CAV, *OTHERS)).situations[0]


def after(then: Situation, now: Situation, steps: int = 1) -> tuple[str, ...] | None:
    """What has changed some steps after a decision; None if nothing is told of it any more."""
    past = PastDecisions()
    past.begin_step()
    past.note(then, DECIDED, "Go after CAV2.")
    for _ in range(steps):
        past.begin_step()
    told = past.of(now)
    if told is None:
        return None
    assert (told.action, told.reason, told.plan, told.ago) == (Action.SLOWER, DECIDED.reason, "Go after CAV2.", steps)
    return told.changes


def faster(situation: Situation, name: str, by: float) -> Situation:
    """The same with one other vehicle at another speed."""
    known = tuple(replace(n, speed=n.speed + by) if n.id == name else n for n in situation.scene.neighbours)
    return replace(situation, scene=replace(situation.scene, neighbours=known))


def ordered(situation: Situation, *first: str) -> Situation:
    """The same with some vehicles before CAV1."""
    order = PassingOrder((), tuple(Precedence(name, "CAV1", "") for name in first))
    return replace(situation, order=order)


def test_a_decision_is_told_for_eight_steps_and_not_in_its_own(met: Situation) -> None:
    assert after(met, met, 0) is None
    assert after(met, met, 8) == ()
    assert after(met, met, 9) is None
    assert PastDecisions().of(met) is None


@pytest.mark.parametrize(
    ("by", "said"),
    [(-1.4, ()), (-1.6, ("HDV1 slowed down from 8.0 to 6.4 m/s",)), (1.6, ("HDV1 sped up from 8.0 to 9.6 m/s",))],
)
def test_speeds_of_others(by: float, said: tuple[str, ...], met: Situation) -> None:
    assert after(met, faster(met, "HDV1", by)) == said


@pytest.mark.parametrize(("speed", "said"), [(6.6, ()), (6.4, ("your speed went from 8.0 to 6.4 m/s",))])
def test_own_speed(speed: float, said: tuple[str, ...], met: Situation) -> None:
    scene = replace(met.scene, ego=replace(met.scene.ego, speed=speed))
    assert after(met, replace(met, scene=scene)) == said


def test_who_goes_before(met: Situation) -> None:
    assert after(ordered(met), ordered(met, "CAV2")) == ("CAV2 now goes before you",)
    assert after(ordered(met, "CAV2"), ordered(met)) == ("CAV2 no longer goes before you",)


def test_who_is_in_conflict(met: Situation) -> None:
    alone = replace(met, conflicts=tuple(c for c in met.conflicts if c.other != "HDV1"))
    assert after(ordered(met), ordered(alone)) == ("HDV1 is no longer in conflict with you",)
    assert after(ordered(alone), ordered(met)) == ("HDV1 is in conflict with you now",)


def test_what_can_no_longer_be_chosen(met: Situation) -> None:
    every = replace(met, assessments=tuple(replace(a, safe=True) for a in met.assessments))
    slow = replace(met, assessments=tuple(replace(a, safe=a.action is Action.SLOWER) for a in met.assessments))
    [said] = after(every, slow) or ()
    assert said.endswith(" can no longer be chosen")
    assert "FASTER" in said
    assert "SLOWER" not in said


def test_four_changes_at_most(met: Situation) -> None:
    scene = replace(met.scene, ego=replace(met.scene.ego, speed=2.0))
    now = faster(faster(ordered(replace(met, scene=scene), "CAV2", "HDV1"), "CAV2", 3.0), "HDV1", -3.0)
    told = after(ordered(met), now)
    assert told is not None
    assert [text.split()[0] for text in told] == ["CAV2", "HDV1", "CAV2", "HDV1"]
