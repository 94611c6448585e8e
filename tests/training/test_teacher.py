"""Who teaches: the rule offline, a language model where one is chosen, and none once advice has no weight."""

import json
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from worlds import Junction, car

from codriving.config.build import build
from codriving.config.training import compose_training
from codriving.datatypes.parts import Model, RuleModel
from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.llm.question import Question
from codriving.llm.scripted import ScriptedChat
from codriving.methods.learned.layout import JUNCTION, feature_count
from codriving.training.advised_observer import AdvisedObserver
from codriving.training.curriculum import Linear
from codriving.training.teacher import Advisor, Guidance

HERE = str(Path(__file__).parent)
if HERE not in sys.path:
    sys.path.insert(0, HERE)

from lone import lone  # noqa: E402  (needs the path above)

DRIVER = compose_training("tell_junction", (), smoke=False)["guidance"]["driver"]
EGO, NEAR = car("CAV1", "south-north", 60.0, 6.0, 9.0), car("HDV1", "south-north", 82.0, 6.0)


class Scripted(Model):
    """A language model that answers by a script."""

    name, ask_plain, prompts = "scripted", False, "planner"

    def __init__(self, script: Callable[[Question], str]) -> None:
        self.asked = ScriptedChat(script)

    def chat(self) -> ScriptedChat:
        """The chat."""
        return self.asked


class Rules(RuleModel):
    """No model."""


def guidance(llm: object, every: int = 1) -> Guidance:
    return Guidance(llm, build(DRIVER, object), every, Linear(1.0, 0.0, 100))  # type: ignore[arg-type]


def advisor(junction: Junction, llm: object, every: int = 1) -> Advisor:
    return Advisor(guidance(llm, every), junction.road_map, junction.model)


def says(action: str) -> Callable[[Question], str]:
    return lambda question: json.dumps({"reason": "so it shall be", "action": action})


def test_the_rule_teaches_offline(junction: Junction) -> None:
    made = advisor(junction, Rules())
    assert made.advise(junction.world(EGO)) == {"CAV1": Action.FASTER}
    ahead = car("HDV1", "south-north", 67.0, 3.0)
    assert made.advise(junction.world(EGO, ahead)) == {"CAV1": Action.SLOWER}


def test_a_model_is_told_what_one_vehicle_sees_and_its_word_counts(junction: Junction) -> None:
    model = Scripted(says("IDLE"))
    made = advisor(junction, model)
    world = junction.world(car("CAV1", "south-north", 77.0, 3.0, 3.0), car("CAV2", "west-south", 77.0, 3.0, 0.0))
    assert made.advise(world) == {"CAV1": Action.IDLE, "CAV2": Action.FASTER}, (
        "the other one turns right, which is plain"
    )
    told = "\n".join(m.content for m in model.asked.questions[0].messages)
    assert model.asked.questions[0].purpose == "decide"
    assert "unknown driver" in told, "it cannot tell who drives"
    assert "west-south" not in told, "routes of others are hidden"
    assert "FASTER: gets" in told, told
    assert "cannot keep the order" not in told


def test_what_a_model_may_choose_is_what_the_rule_leaves(junction: Junction) -> None:
    model = Scripted(says("FASTER"))
    advice = advisor(junction, model).advise(junction.world(EGO, car("HDV1", "south-north", 67.0, 3.0)))
    assert len(model.asked.questions) == 2, "asked again"
    assert "too close to" in model.asked.questions[1].messages[-1].content
    assert advice == {"CAV1": Action.SLOWER}


def test_it_is_asked_now_and_then_only(junction: Junction) -> None:
    model = Scripted(says("SLOWER"))
    made = advisor(junction, model, every=3)
    found = [bool(made.advise(junction.world(EGO, NEAR, time=k / 2, step=k))) for k in range(7)]
    assert found == [True, False, False, True, False, False, True]
    made.asks = False
    assert not made.advise(junction.world(EGO, NEAR, time=4.5, step=9))
    assert len(model.asked.questions) == 3


def test_a_model_is_not_asked_what_is_plain(junction: Junction) -> None:
    model = Scripted(says("IDLE"))
    assert advisor(junction, model).advise(junction.world(EGO)) == {"CAV1": Action.FASTER}
    assert not model.asked.questions


def test_sight_puts_features_mask_and_advice_into_a_row(junction: Junction) -> None:
    model, features = junction.model, feature_count(JUNCTION)
    taught = AdvisedObserver(junction.road_map, model, JUNCTION, advisor(junction, Rules()))
    row = taught.observe(junction.world(EGO))["CAV1"]
    assert row.shape == taught.nothing().shape == (features + 6,)
    assert row[features:].tolist() == [1, 1, 1, 0, 0, 1]
    alone = AdvisedObserver(junction.road_map, model, JUNCTION, None).observe(junction.world(EGO))["CAV1"]
    assert alone[features:].tolist() == [1, 1, 1, 0, 0, 0]
    assert alone[:features].tolist() == row[:features].tolist()


def test_drivers_of_two_environments_do_not_share_a_memory(junction: Junction) -> None:
    one = guidance(Rules())
    teachers = [Advisor(one, junction.road_map, junction.model) for _ in range(2)]
    assert teachers[0]._alone.driver is not teachers[1]._alone.driver


def test_llm_puts_a_model_in_the_place_of_the_teacher() -> None:
    chosen = compose_training("tell_junction", ("llm=ollama", "llm.temperature=0.5", "seed=3"), smoke=False)
    llm = chosen["guidance"]["llm"]
    assert (llm["model"], llm["temperature"]) == ("ollama_chat/llama3.1:8b", 0.5)
    assert chosen["seed"] == 3
    assert build(llm, object).name == "ollama_chat/llama3.1:8b"
    assert lone("tell").teacher == "rules"
    with pytest.raises(ConfigError, match="this training has no teacher"):
        compose_training("ppo_junction", ("llm=ollama",), smoke=False)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [(("guidance.every=0",), "every must be"), (("guidance.pull.start=-1.0",), "pull must be")],
)
def test_settings_out_of_range_are_refused(overrides: tuple[str, ...], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        lone("tell", *overrides)
