"""What was asked during one decision step: the counters of the tables and the lines of the transcript."""

from collections import Counter
from dataclasses import asdict
from typing import Any

from codriving.llm.answers import CUT_OFF, FILTERED
from codriving.llm.question import Answer, Call, Question

# Counters of whose the decisions and the ordered pairs were; a record without them is of a version that did not count.
WHOSE = (
    *("model_decisions", "mended_decisions", "single_decisions", "fallback_decisions"),
    *("model_pairs", "mended_pairs", "repaired_pairs", "fallback_pairs"),
)


class Ledger:
    """Notes every answer; one for each episode, whose seed for what is drawn it may be told."""

    def __init__(self, seed: int = 0) -> None:
        self._seed, self._asked = seed, 0
        self._counts = _zeros()
        self._cost = 0.0
        self._noted: list[tuple[Question, Answer]] = []

    def occasion(self) -> str:
        """Mark the next question of the episode."""
        self._asked += 1
        return f"{self._seed} {self._asked}"

    def note(self, question: Question, answer: Answer) -> None:
        """Note an answer."""
        self._noted.append((question, answer))
        self._counts["model_calls"] += len(answer.calls)
        self._counts["prompt_tokens"] += sum(call.prompt_tokens for call in answer.calls)
        self._counts["completion_tokens"] += sum(call.completion_tokens for call in answer.calls)
        self._counts["re_asks"] += answer.asked_again
        self._counts["mended"] += answer.mended
        self._counts["fallbacks"] += answer.value is None
        self._counts["cached_tokens"] += sum(call.cached_tokens for call in answer.calls)
        self._counts["reasoning_tokens"] += sum(call.reasoning_tokens for call in answer.calls)
        self._counts["cut_off"] += sum(call.finish_reason.lower() in CUT_OFF for call in answer.calls)
        self._counts["withheld"] += sum(call.finish_reason.lower() in FILTERED for call in answer.calls)
        self._counts["shortened"] += answer.shortened
        self._cost += sum(call.cost or 0.0 for call in answer.calls)
        if unpriced := sum(call.cost is None for call in answer.calls):
            self._counts["unpriced_calls"] += unpriced

    def count(self, name: str, number: int = 1) -> None:
        """Count something else, for instance a repaired order."""
        self._counts[name] += number

    def decided(self, options: int, mended: bool, as_rules: bool | None) -> None:
        """Count a decision that was asked for and answered.

        Args:
            options: Actions that it was chosen among; of one alone there is nothing to decide.
            as_rules: Whether the rules would have decided the same; None where there are none to compare with.
        """
        if options < 2:
            self.count("single_decisions")
            return
        self.count("model_decisions")
        self.count("mended_decisions", mended)
        if as_rules is not None:
            self.count("decisions_as_rules", as_rules)

    def ordered(self, asked: int, said: int, mended: bool, as_rules: int) -> None:
        """Count the pairs of an order that was asked for and answered.

        Args:
            asked: Pairs that it was asked about.
            said: Those of them that are ordered as the model said; the rules ordered the others.
            as_rules: Those that the rules would have ordered the same.
        """
        self.count("model_pairs", said)
        self.count("mended_pairs", said * mended)
        self.count("repaired_pairs", asked - said)
        self.count("pairs_as_rules", as_rules)

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
        self._counts, self._cost, self._noted = _zeros(), 0.0, []
        return counts, lines


def _zeros() -> Counter[str]:
    return Counter(dict.fromkeys(WHOSE, 0))


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
