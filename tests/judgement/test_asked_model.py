"""The language model as a judge: asked before order and actions, once a step, and read with tolerance."""

import json
import re
from pathlib import Path

import pytest
from asked import Scripted
from remembered import interaction, online
from worlds import FULL, Junction, car

from codriving.datatypes.judgement import MetDriver
from codriving.datatypes.parts import CaseMemory
from codriving.datatypes.world import WorldState
from codriving.errors import ConfigError
from codriving.judgement.asked_model import AskedModel
from codriving.judgement.contests import contests
from codriving.llm.prompts.judging import chances, judgement_reply
from codriving.llm.question import Question
from codriving.llm.scripted import ScriptedChat
from codriving.methods.codriving import CoDriving
from codriving.reasoning.sharing.sharing import CdaLevel


def world(junction: Junction) -> WorldState:
    """Two CAVs, each of which meets the same human driver, who has the right of way."""
    return junction.world(
        car("CAV1", "south-north", 80.0, 8.0, 9.0),
        car("CAV2", "north-south", 80.0, 8.0, 9.0),
        car("HDV1", "east-west", 76.0, 8.0),
    )


def asked(junction: Junction, chance: object, memory: CaseMemory | None = None) -> tuple[CoDriving, ScriptedChat]:
    """The method with a model that says the same of all drivers, and what it was asked in one step."""

    def script(question: Question) -> str:
        if question.purpose == "judge":
            return json.dumps({**dict.fromkeys(question.schema.model_fields, chance), "reason": "it brakes"})
        return json.dumps({"reason": "", "action": "SLOWER", "p1": "CAV1"})

    chat = ScriptedChat(script)
    method = CoDriving(CdaLevel(**FULL), Scripted(chat), memory, 1.5, judgement=AskedModel(0.5, 0.5))
    method.reset(junction.road_map, junction.model, 0)
    return method, chat


def test_all_pairs_are_asked_about_at_once_and_before_all_else(junction: Junction) -> None:
    method, chat = asked(junction, 0.9)
    deliberation = method.act(world(junction))
    first, *others = (question.purpose for question in chat.questions)
    assert first == "judge"
    assert "judge" not in others
    text = chat.questions[0].messages[-1].content
    assert "would HDV1 let CAV1 pass first" in text
    assert "would HDV1 let CAV2 pass first" in text
    assert "right of way: HDV1" in text
    orders = [s.order.first_of(s.scene.ego.id, "HDV1") for s in deliberation.situations]
    assert orders == ["CAV1", "CAV2"]
    judged = deliberation.situations[0].judgements["HDV1"]
    assert (judged.yields, judged.answer, judged.reason) == (0.9, "yields", "judged by the model: it brakes")
    assert deliberation.counts["model_calls"] == len(chat.questions)


def test_with_a_memory_it_is_told_what_drivers_did_in_like_cases(junction: Junction, tmp_path: Path) -> None:
    memory = online(tmp_path / "m.sqlite")
    memory.begin(interaction())
    [contest, _] = contests(junction.think(world(junction)).moment())
    met = [MetDriver("CAV1", f"HDV{k}", k, contest.numbers, bool(contest.rule), k < 2) for k in range(6)]
    memory.learn([], met)
    memory.begin(interaction(20_001))
    method, chat = asked(junction, 0.9, memory)
    method.act(world(junction))
    told = [line for line in chat.questions[0].messages[-1].content.splitlines() if "right of way" in line]
    assert [line.partition("; seen before: ")[2] for line in told] == [
        "2 of 6 drivers met in like cases let the CAV pass"
    ] * 2
    plain, chat = asked(junction, 0.9)
    plain.act(world(junction))
    assert "seen before" not in chat.questions[0].messages[-1].content


def test_a_question_that_is_too_long_keeps_the_more_urgent_half(junction: Junction) -> None:
    method, chat = asked(junction, 0.9)
    method.act(
        junction.world(
            car("CAV1", "south-north", 80.0, 8.0, 9.0),
            car("CAV2", "north-south", 84.0, 8.0, 9.0),
            car("HDV1", "east-west", 76.0, 8.0),
        )
    )
    shorter = chat.questions[0].shorter()
    assert shorter is not None
    for question, cavs in ((chat.questions[0], ["CAV2", "CAV1"]), (shorter, ["CAV2"])):
        text = question.messages[-1].content
        assert re.findall(r"would HDV1 let (\w+) pass first", text) == cavs
        assert [name for name in question.schema.model_fields if name != "reason"] == ["p1", "p2"][: len(cavs)]
    assert shorter.shorter() is None


@pytest.mark.parametrize(("chance", "first"), [(0.1, "HDV1"), (None, "HDV1"), ("nobody knows", "HDV1")])
def test_what_is_low_or_no_answer_leaves_the_driver_first(chance: object, first: str, junction: Junction) -> None:
    method, _ = asked(junction, chance)
    deliberation = method.act(world(junction))
    assert deliberation.situations[0].order.first_of("CAV1", "HDV1") == first


@pytest.mark.parametrize(
    ("told", "expected"),
    [
        ({"p1": 0.25}, {"p1": 0.25}),
        ({"P1": "0.25", "p2": "75%"}, {"p1": 0.25, "p2": 0.75}),
        ({"p1": "yields", "p2": "goes"}, {"p1": 0.9, "p2": 0.1}),
        ({"p1": {"yields": 0.4}, "p3": 0.1}, {"p1": 0.4}),
        ({"p1": 1.5, "p2": "HDV1"}, {}),
        ({"p1": True}, {"p1": 0.9}),
        ({"p1": 10**400, "p2": 0.5}, {"p2": 0.5}),
        ({"p1": "nan", "p2": float("inf")}, {}),
        ([0.4], {}),
    ],
)
def test_answers_are_read_with_tolerance(told: object, expected: dict[str, float]) -> None:
    assert chances(judgement_reply(["p1", "p2"]).model_validate(told)) == expected


def test_no_model_no_judge() -> None:
    method = CoDriving(CdaLevel(**FULL), Scripted(ScriptedChat(lambda question: "")), None, 1.5)
    assert method.asked == ("negotiate", "decide")
    method.rely_on(AskedModel(0.5, 0.5))
    assert method.judge is None


def test_thresholds_do_not_cross() -> None:
    with pytest.raises(ConfigError, match=r"goes_below must be at most yields_above, got 0.6, 0.4"):
        AskedModel(0.4, 0.6)
