"""What was decided in an episode as lines of chats: what a model would be asked, and the answer that was given."""

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from codriving.datatypes import ActionAssessment, Conflict, Judgement, PassingOrder, SceneDescription, Situation
from codriving.exam.plain import restored
from codriving.llm import decision_reply, decision_view, load_prompts

PROMPTS = "planner"  # The set that prints nothing but what is kept of a situation


def of_transcript(lines: Iterable[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
    """Give the questions of a model to which it had a usable answer, in the words in which it was asked."""
    for line in lines:
        if line["value"] is None or not line["calls"]:
            continue
        asked = line["calls"][min(line["shortened"], len(line["calls"]) - 1)]["messages"]
        given = {key: value for key, value in line["value"].items() if value is not None}
        yield _chat(asked, given, line["time"], line["purpose"], line["subject"])


def of_decisions(lines: Iterable[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
    """Give the decisions of a method that describes the situation of each CAV, where there was anything to choose."""
    for line in lines:
        for entry in line.get("cavs", ()):
            if "scene" not in entry or entry["action"] not in entry["allowed"] or len(entry["allowed"]) < 2:
                continue
            asked = load_prompts(PROMPTS).messages("decide", decision_view(_situation(entry)))
            answer = decision_reply(tuple(entry["allowed"]))(reason=entry["reason"], action=entry["action"])
            messages = [{"role": message.role, "content": message.content} for message in asked]
            yield _chat(messages, answer.model_dump(mode="json"), line["time"], "decide", entry["id"])


def _chat(asked: list[Any], answer: Mapping[str, Any], time: float, purpose: str, subject: str) -> dict[str, Any]:
    said = {"role": "assistant", "content": json.dumps(answer, ensure_ascii=False)}
    return {"messages": [*asked, said], "time": time, "purpose": purpose, "cav": subject}


def _situation(entry: Mapping[str, Any]) -> Situation:
    conflicts = [{key: value for key, value in c.items() if key != "clear_time"} for c in entry["conflicts"]]
    return Situation(
        restored(SceneDescription, entry["scene"]),
        restored(tuple[Conflict, ...], conflicts),
        restored(PassingOrder, entry["order"]),
        tuple(restored(float, c["clear_time"]) for c in entry["conflicts"]),
        restored(tuple[ActionAssessment, ...], entry["assessments"]),
        judgements=restored(Mapping[str, Judgement], entry.get("judgements", {})),
    )
