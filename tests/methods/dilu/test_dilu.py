"""DiLu as a method: how it is called, what it holds, what it falls back to, and that it drives everywhere."""

import hashlib
import json
from collections.abc import Callable
from pathlib import Path

import pytest
from asked import Scripted
from dilu_driven import NEVER_HELD, Notebook, always, modelled, rule, ruled
from driven import drive
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from worlds import Junction, car

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.experience import Interaction, Memory, Verdict
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment
from codriving.errors import ConfigError
from codriving.llm.language_model import Offline
from codriving.llm.scripted import ScriptedChat
from codriving.memory.online import OnlineMemory
from codriving.methods.dilu.dilu import DiLu

CARS = (
    car("CAV1", "south-north", 86, 8, 9),
    car("CAV2", "west-east", 85, 8, 9),
    car("HDV1", "north-south", 90, 7),
)


def test_rules_are_not_called_dilu(junction: Junction) -> None:
    offline, (model, _) = ruled(junction), modelled(junction, always("IDLE"))
    assert (offline.name, offline.reasoner, offline.remembers) == ("dilu-rule", "rules", "")
    assert (model.name, model.reasoner) == ("dilu", "scripted")
    assert ruled(junction, Notebook()).remembers == "notebook"


@pytest.mark.parametrize(("hold", "shots", "said"), [(0.0, 3, "hold"), (11.0, 3, "hold"), (1.0, 0, "shots")])
def test_settings_out_of_range_are_refused(hold: float, shots: int, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        DiLu(Offline(), None, hold, shots, rule())


def test_templates_of_a_folder_are_used_and_broken_ones_refused(junction: Junction, tmp_path: Path) -> None:
    template = tmp_path / "dilu.user.md.j2"
    template.write_text("You drive {{ speed|mps }}. Allowed actions: {{ allowed|join(', ') }}")
    chat = ScriptedChat(always("IDLE"))
    made = DiLu(Scripted(chat, prompts=str(tmp_path)), None, 1.0, 3, rule())
    made.reset(junction.road_map, junction.model, 0)
    made.act(junction.world(CARS[0]))
    assert chat.questions[0].messages[1].content == "You drive 8.0 m/s. Allowed actions: SLOWER, IDLE, FASTER"
    broken = tmp_path / "broken"
    broken.mkdir()
    (broken / template.name).write_text("{{ routes_of_others }}")
    with pytest.raises(ConfigError, match="no variable 'routes_of_others'"):
        DiLu(Scripted(chat, prompts=str(broken)), None, 1.0, 3, rule())


def test_a_model_that_is_to_reflect_has_to_be_there() -> None:
    book = Notebook()
    book.reflections = 3
    with pytest.raises(ConfigError, match=r"memory\.reflection=llm needs a language model"):
        DiLu(Offline(), book, 1.0, 3, rule())


def test_decision_holds_for_a_second(junction: Junction) -> None:
    made, chat = modelled(junction, always("SLOWER"))
    first = made.act(junction.world(*CARS))
    assert (chat.calls, chat.rounds) == (2, 1)
    held = made.act(junction.world(*CARS, time=0.5, step=1))
    assert chat.calls == 2
    assert set(held.actions.values()) == {Action.IDLE}
    assert held.decisions[0].reason == "holds SLOWER: it is free"
    assert held.transcript == ()
    again = made.act(junction.world(*CARS, time=1.0, step=2))
    assert (chat.calls, chat.rounds) == (4, 2)
    assert first.actions == again.actions == {"CAV1": Action.SLOWER, "CAV2": Action.SLOWER}
    assert again.counts["model_calls"] == 2


def test_newcomer_is_not_left_without_a_decision(junction: Junction) -> None:
    made, chat = modelled(junction, always("SLOWER"))
    made.act(junction.world(*CARS[:1]))
    assert set(made.act(junction.world(*CARS, time=0.5, step=1)).actions) == {"CAV1", "CAV2"}
    assert chat.calls == 3


def test_missing_answer_is_a_counted_fallback(junction: Junction) -> None:
    made, chat = modelled(junction, lambda question: "I would rather not say.")
    done = made.act(junction.world(*CARS))
    assert set(done.actions.values()) == {Action.IDLE}
    assert (done.counts["fallbacks"], done.counts["re_asks"], chat.calls) == (2, 2, 4)
    assert all(d.reason.startswith("fallback") for d in done.decisions)


def test_second_answer_counts_and_is_told_what_may_be_chosen(junction: Junction) -> None:
    answers = iter(["LANE_LEFT", "FASTER"])
    made, chat = modelled(junction, lambda question: json.dumps({"action": next(answers)}))
    done = made.act(junction.world(CARS[0]))
    assert done.actions == {"CAV1": Action.FASTER}
    assert "LANE_LEFT is not one of: SLOWER, IDLE, FASTER" in chat.questions[1].messages[-1].content


@settings(max_examples=10, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.one_of(
        st.text(max_size=200),
        st.sampled_from(["faster", " Slower ", "LANE_RIGHT", "", "GO", "IDLE\x00"]).map(
            lambda a: json.dumps({"reason": "r", "action": a})
        ),
        st.dictionaries(st.sampled_from(["reason", "action"]), st.one_of(st.none(), st.integers(), st.text())).map(
            json.dumps
        ),
    )
)
def test_whatever_a_model_says_something_allowed_is_done(junction: Junction, said: str) -> None:
    made, _ = modelled(junction, lambda question: f"<think>{{}}</think> {said}")
    done = made.act(junction.world(*CARS))
    fell_back = done.counts["fallbacks"] == 2
    for situation, decision in zip(done.situations, done.decisions, strict=True):
        assert decision.action in situation.allowed
        assert decision.reason.startswith("fallback") is fell_back


def test_question_gets_shorter_until_nothing_is_left(junction: Junction) -> None:
    remembered = Memory(1, "Wait for whoever is there first.", Action.SLOWER, Verdict.EASED, 0.95, 1)
    made, chat = modelled(junction, always("IDLE"), Notebook([remembered], learns=False))
    made.act(junction.world(*CARS))
    question, sizes = chat.questions[0], []
    assert remembered.text in question.messages[1].content
    while question is not None:
        sizes.append(len(question.messages[1].content))
        question = question.shorter()
        assert question is None or remembered.text not in question.messages[1].content
    assert sizes == sorted(set(sizes), reverse=True)
    assert len(sizes) == 3


def test_mistake_that_is_remembered_is_not_repeated(junction: Junction) -> None:
    def remember(action: Action, verdict: Verdict) -> Memory:
        return Memory(7, "", action, verdict, 0.97, 1)

    alone = junction.world(car("CAV1", "south-north", 40, 6, 6))
    assert ruled(junction).act(alone).actions == {"CAV1": Action.FASTER}
    mistake = remember(Action.FASTER, Verdict.INTENSIFIED)
    done = ruled(junction, Notebook([mistake])).act(alone)
    assert (done.decisions[0].action, done.decisions[0].recalled) == (Action.IDLE, (7,))
    assert done.counts["reconsidered"] == 1
    balanced = [mistake, remember(Action.FASTER, Verdict.EASED)]
    assert ruled(junction, Notebook(balanced)).act(alone).actions == {"CAV1": Action.FASTER}
    # Of what is recalled only the most similar are told.
    shot = ruled(junction, Notebook([*balanced[::-1], mistake]), shots=1).act(alone)
    assert shot.actions == {"CAV1": Action.FASTER}
    assert shot.counts["recalled"] == 1


@pytest.mark.parametrize("scenario", ["intersection", "roundabout", "highway", "merge"])
def test_drives_in_every_scenario(scenario: str, configured: Callable[..., Environment]) -> None:
    junction = Junction(configured(f"scenario={scenario}"))
    for made in (ruled(junction), modelled(junction, always("IDLE"))[0]):
        driven = drive(junction.environment, made, 10_001, decisions=12)
        assert len(driven.worlds) >= 12


def memory(file: Path, kind: str = "online") -> object:
    return build(compose(["method=dilu", f"memory={kind}", f"memory.file={file}"])["memory"], object, "memory")


def test_what_is_learnt_is_recalled_alike_and_a_frozen_memory_stays_as_it_is(
    junction: Junction, tmp_path: Path
) -> None:
    file = tmp_path / "m.sqlite"
    online = memory(file)
    assert isinstance(online, OnlineMemory)
    learner = DiLu(Offline(), online, 1.0, 3, rule())
    environment = junction.environment
    world, outcome = environment.reset(20_000), None
    online.begin(Interaction("intersection", 20_000, "dilu-rule", "", "rules"))
    learner.reset(junction.road_map, junction.model, 20_000)
    while (outcome := environment.outcome) is None:
        world = environment.step(learner.act(world).actions)
    counts, _ = learner.conclude(world, outcome)
    assert counts["experiences"] > 2
    before = hashlib.sha256(file.read_bytes()).hexdigest()
    told = []
    for _ in range(2):
        frozen = DiLu(Offline(), memory(file, "frozen"), NEVER_HELD, 3, rule())  # type: ignore[arg-type]
        world = environment.reset(20_000)
        frozen.reset(junction.road_map, junction.model, 20_000)
        steps = []
        while (outcome := environment.outcome) is None:
            steps.append(frozen.act(world))
            world = environment.step(steps[-1].actions)
        assert frozen.conclude(world, outcome) == ({}, [])
        told.append([(m.id, m.similarity) for step in steps for s in step.situations for m in s.memories])
    assert told[0] == told[1]
    assert len(told[0]) > 2
    assert hashlib.sha256(file.read_bytes()).hexdigest() == before
    assert [p.name for p in tmp_path.iterdir()] == ["m.sqlite"]
