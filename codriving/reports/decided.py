"""Whose decision it was: how much of what was driven a language model decided, and what decided the rest."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from codriving.reports.columns import Value, share
from codriving.reports.wording import percent

ENOUGH = 0.9  # Below this share a table says that much of what it shows is not the model's

COUNTED = "model_decisions"  # A record that lacks this counter is of a version that did not count

DECIDED_NOTE = (
    "By model: share of all decisions, and of the pairs of CAVs that it was asked about, that the model decided among "
    "two options or more; mended ones are read tolerantly. The rest: plain, not asked; one option, nothing to decide; "
    "repaired, left out of an order or in a circle, so ordered by rule; fallback, no usable answer."
)

AS_RULES_NOTE = (
    "As rules: share of what the model decided that the built-in rules would have decided in the same situation."
)


@dataclass(frozen=True, slots=True)
class Breakdown:
    """What became of the decisions, or of the pairs, of one cell."""

    model: int  # Decided by the model
    mended: int  # Those of them that only the tolerant reading understood
    rest: Mapping[str, int]  # What decided the others, in words
    as_rules: int | None  # Those of the model's that the rules would have decided the same; None where not compared

    @property
    def total(self) -> int:
        """All of them."""
        return self.model + sum(self.rest.values())

    @property
    def by_model(self) -> float | None:
        """Share that the model decided."""
        return share(self.model, self.total)

    @property
    def like_rules(self) -> float | None:
        """Share of the model's that the rules would have decided the same."""
        return None if self.as_rules is None else share(self.as_rules, self.model)

    def part(self, what: str) -> float | None:
        """Give the share of something in words, or of ``mended``."""
        return share(self.mended if what == "mended" else self.rest[what], self.total)

    @property
    def others(self) -> str:
        """Say what decided the rest, the most first."""
        parts = sorted(((number, what) for what, number in self.rest.items() if number), reverse=True)
        return ", ".join(f"{what} {percent(share(number, self.total))}" for number, what in parts)


PLAIN, ONE_OPTION, REPAIRED, FALLBACK = "plain", "one option", "repaired", "fallback"


@dataclass(frozen=True, slots=True)
class Decided:
    """Whose decisions and pairs were."""

    decisions: Breakdown
    pairs: Breakdown

    @classmethod
    def of(cls, counts: Sequence[Mapping[str, float]]) -> "Decided":
        """Add up what records counted."""

        def total(name: str) -> int:
            return int(sum(found.get(name, 0) for found in counts))

        def compared(name: str) -> int | None:
            return total(name) if any(name in found for found in counts) else None

        rest = {PLAIN: total("plain_decisions"), ONE_OPTION: total("single_decisions")}
        rest[FALLBACK] = total("fallback_decisions")
        others = {REPAIRED: total("repaired_pairs"), FALLBACK: total("fallback_pairs")}
        return cls(
            Breakdown(total("model_decisions"), total("mended_decisions"), rest, compared("decisions_as_rules")),
            Breakdown(total("model_pairs"), total("mended_pairs"), others, compared("pairs_as_rules")),
        )

    def warning(self, name: str) -> str:
        """Say that much of what is shown is not the model's; empty where most of it is."""
        both = (("decisions", self.decisions), ("pairs that it was asked about", self.pairs))
        few = [
            f"{percent(shares.by_model)} of the {what} ({shares.others})"
            for what, shares in both
            if shares.by_model is not None and shares.by_model < ENOUGH
        ]
        return f"Not all of this is the model's: {name} decided {' and '.join(few)}." if few else ""


def decisions_by_model(decided: Decided | None) -> Value:
    """Give the share of decisions that are a model's."""
    return decided.decisions.by_model if decided else None


def pairs_by_model(decided: Decided | None) -> Value:
    """Give the share of pairs that are a model's."""
    return decided.pairs.by_model if decided else None
