"""The exam of CoDriving as a task of inspect_ai: any model that it knows, its logs and its viewer."""

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Any

from inspect_ai import Task, task
from inspect_ai.dataset import MemoryDataset, Sample
from inspect_ai.model import ChatMessage, ChatMessageSystem, ChatMessageUser
from inspect_ai.scorer import Score, Scorer, Target, grouped, mean, scorer, stderr
from inspect_ai.solver import TaskState, generate

from codriving.exam import OURS, mark, read_exam, some
from codriving.exam.sitting import Asked, as_said, wording

_ROLES: dict[str, Callable[..., ChatMessage]] = {"system": ChatMessageSystem, "user": ChatMessageUser}


@task
def codriving_exam(most: int | None = None, file: str | None = None, prompts: str | None = None) -> Task:
    """Ask the stored situations and negotiations of CoDriving.

    Args:
        most: Situations and negotiations at most, evenly taken of all.
        file: Another exam than the one in the package.
        prompts: Set of prompts, or a folder with templates.
    """
    exam = read_exam(Path(file) if file else OURS)
    questions = {question.name: question for question in some(exam, most)}
    samples = [
        Sample(
            id=f"{name}-{asked.purpose}",
            input=[_ROLES[message.role](content=message.content) for message in asked.messages],
            metadata={"question": name, "purpose": asked.purpose, "world": question.origin.world},
        )
        for name, question in questions.items()
        for asked in wording(question, prompts)
    ]
    scorers = [acceptable(questions, prompts), safe(questions, prompts)]
    dataset = MemoryDataset(samples, name=f"exam {exam.sha256[:12]}")
    return Task(dataset=dataset, solver=generate(), scorer=scorers, version=exam.sha256[:12])


@scorer(metrics=[grouped(mean(), "purpose"), stderr()])
def acceptable(questions: dict[str, Asked], prompts: str | None) -> Scorer:
    """Judge as `codriving exam` does: 1 or 0; of several pairs or drivers in one question their share."""
    return _judge(questions, prompts, "acceptable")


@scorer(metrics=[grouped(mean(), "purpose"), stderr()])
def safe(questions: dict[str, Asked], prompts: str | None) -> Scorer:
    """Judge likewise, of decisions only whether they are safe."""
    return _judge(questions, prompts, "safe")


def _judge(questions: dict[str, Asked], prompts: str | None, what: str) -> Scorer:
    async def score(state: TaskState, target: Target) -> Score:
        purpose, said = state.metadata["purpose"], state.output.completion
        # Reading answers has an event loop of its own.
        answered = await asyncio.to_thread(as_said, questions[state.metadata["question"]], {purpose: said}, prompts)
        counts = mark([[answered]])
        part, whole = {
            "decide": (what, "situations"),
            "negotiate": ("pairs_acceptable", "pairs"),
            "judge": ("drivers_right", "drivers"),
        }[purpose]
        value = counts.get(part, 0) / counts[whole] if counts.get(whole) else 0.0
        return Score(value=value, answer=str(answered.decided), explanation=_explained(answered.asked, purpose))

    return score


def _explained(asked: Any, purpose: str) -> str:  # noqa: ANN401 - any question
    """Say what came of each answer."""
    if purpose == "decide":
        return "\n".join(f"{action}: {consequence}" for action, consequence in asked.actions.items())
    if purpose == "judge":
        return f"they let the CAV pass: {asked.yields}"
    return "\n".join(f"{p.one} first: {p.if_one}; {p.other} first: {p.if_other}" for p in asked.pairs)
