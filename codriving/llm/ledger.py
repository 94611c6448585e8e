"""What was asked during one decision step: the counters of the tables and the lines of the transcript."""

from collections import Counter
from dataclasses import asdict
from typing import Any

from codriving.llm.question import Answer, Call, Question


class Ledger:
    """Notes every answer; one for each episode."""

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()
        self._cost = 0.0
        self._noted: list[tuple[Question, Answer]] = []

    def note(self, question: Question, answer: Answer) -> None:
        """Note an answer."""
        self._noted.append((question, answer))
        self._counts["model_calls"] += len(answer.calls)
        self._counts["prompt_tokens"] += sum(call.prompt_tokens for call in answer.calls)
        self._counts["completion_tokens"] += sum(call.completion_tokens for call in answer.calls)
        self._counts["re_asks"] += answer.asked_again
        self._counts["mended"] += answer.mended
        self._counts["fallbacks"] += answer.value is None
        self._counts["shortened"] += answer.shortened
        self._cost += sum(call.cost or 0.0 for call in answer.calls)
        if unpriced := sum(call.cost is None for call in answer.calls):
            self._counts["unpriced_calls"] += unpriced

    def count(self, name: str, number: int = 1) -> None:
        """Count something else, for instance a repaired order."""
        self._counts[name] += number

    def asked(self) -> list[tuple[str, str, list[float]]]:
        """Return purpose and subject of each question of this step, and how long each of its requests took [s]."""
        return [(q.purpose, q.subject, [call.seconds for call in answer.calls]) for q, answer in self._noted]

    def close_step(self, time: float) -> tuple[dict[str, float], list[dict[str, Any]]]:
        """Return what has been noted since the last step, and begin the next one.

        Args:
            time: Simulated time of the step [s].

        Returns:
            Counters by column, and one line of ``transcript.jsonl`` an answer.
        """
        # The questions of one purpose are asked at once, the purposes one by one.
        longest: dict[str, float] = {}
        for question, answer in self._noted:
            seconds = sum(call.seconds for call in answer.calls)
            longest[question.purpose] = max(seconds, longest.get(question.purpose, 0.0))
        counts = {**self._counts, "cost_usd": self._cost, "model_seconds": sum(longest.values())}
        lines = [_line(question, answer, time) for question, answer in self._noted]
        self._counts, self._cost, self._noted = Counter(), 0.0, []
        return counts, lines


def _line(question: Question, answer: Answer, time: float) -> dict[str, Any]:
    return {
        "time": time,
        "purpose": question.purpose,
        "subject": question.subject,
        "value": None if answer.value is None else answer.value.model_dump(mode="json"),
        "problem": answer.problem,
        "mended": answer.mended,
        "shortened": answer.shortened,
        "calls": [_told(call) for call in answer.calls],
    }


def _told(call: Call) -> dict[str, Any]:
    """What is kept of a call; a model that is called by its own name is not named again."""
    left_out = ("cached",) if call.model else ("cached", "model")
    return {key: value for key, value in asdict(call).items() if key not in left_out}
