"""How long a thought takes: as stated, or by the questions to a language model."""

from typing import Any

import pytest
from asked import Scripted, sensible
from dilu_driven import modelled
from worlds import FULL, Junction, car

from codriving.datatypes.world import Action
from codriving.llm.scripted import ScriptedChat
from codriving.methods.codriving import CoDriving
from codriving.reasoning.sharing.sharing import CdaLevel
from codriving.wrappers.delays import Delays
from codriving.wrappers.slow import Slow
from codriving.wrappers.thinking import Thinking

ASKED = (
    ("negotiate", "", [0.4]),
    ("decide", "CAV1", [0.2, 0.9]),  # Asked again
    ("decide", "CAV2", [0.3]),
)
LEVEL = CdaLevel(**FULL)

MEET = car("CAV1", "south-north", 60.0, 8.0, 9.0), car("CAV2", "west-east", 60.0, 8.0, 9.0)
FAR = car("CAV3", "east-west", 5.0, 8.0, 9.0)


@pytest.mark.parametrize(
    ("latency", "order", "first", "second", "third"),
    [
        ("none", 2.0, 1.0, 1.0, 1.0),
        ("measured", 0.4, 1.1, 0.3, 0.0),
        (0.7, 0.7, 1.4, 0.7, 0.0),
        (0.0, 0.0, 0.0, 0.0, 0.0),
    ],
)
def test_orders_take_the_time_of_their_question_and_decisions_that_of_their_cav(
    latency: Any, order: float, first: float, second: float, third: float
) -> None:
    delays = Delays(1.0, 2.0, latency)
    assert delays.of_order(ASKED) == order
    assert [delays.of_mind(ASKED, f"CAV{k}") for k in (1, 2, 3)] == pytest.approx([first, second, third])
    assert delays.of_order(ASKED[1:]) == (2.0 if latency == "none" else 0.0)


def test_a_question_to_a_model_takes_its_time_in_the_place_of_what_is_stated(junction: Junction) -> None:
    model = Scripted(ScriptedChat(sensible), prompts="planner")
    model.latency = 0.7
    made = Thinking(9.0, 9.0, LEVEL).around(CoDriving(LEVEL, model, None, 1.5), model)
    made.reset(junction.road_map, junction.model, 0)
    found = [made.act(junction.world(*MEET, time=0.5 * k, step=k)) for k in range(5)]
    assert [f.counts["late_decisions"] for f in found] == [0, 0, 2, 0, 2]
    # The order that arrives at 1.0 s still holds, so that nothing is asked and no time taken.
    assert [f.counts["late_orders"] for f in found] == [0, 0, 1, 0, 0]
    assert [q.purpose for q in model.scripted.questions].count("negotiate") == 1
    assert "can be there earlier" in found[2].as_dict()["cavs"][0]["order"]["precedences"][0]["reason"]


def test_what_no_model_is_asked_takes_no_time(junction: Junction) -> None:
    model = Scripted(ScriptedChat(sensible))
    model.latency = 0.7
    made = Thinking(0.0, 0.0, LEVEL).around(CoDriving(LEVEL, model, None, 1.5), model)
    made.reset(junction.road_map, junction.model, 0)
    found = made.act(junction.world(FAR))
    assert (found.actions, found.counts["plain_decisions"]) == ({"CAV3": Action.FASTER}, 1)
    assert (found.counts["reflexes"], model.scripted.questions) == (0, [])


def test_each_cav_of_another_method_waits_for_its_own_answer(junction: Junction) -> None:
    dilu, _ = modelled(junction, lambda q: '{"action": "FASTER", "reason": "so"}', hold=0.5)
    made = Slow(dilu, LEVEL, 1.5, Delays(0.0, 0.0, 0.7))
    made.reset(junction.road_map, junction.model, 0)
    cars = car("CAV1", "south-north", 20.0, 8.0, 8.0), car("CAV2", "west-east", 20.0, 8.0, 8.0)
    found = [made.act(junction.world(*cars, time=0.5 * k, step=k)) for k in range(3)]
    assert [f.actions["CAV1"] for f in found] == [Action.IDLE, Action.IDLE, Action.FASTER]
    assert [len(f.transcript) for f in found] == [2, 0, 2]
