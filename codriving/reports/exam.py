"""``exam.*``: what each model, control and the rules answered to the stored questions."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from codriving.metrics import wilson_interval
from codriving.reports.columns import Column, Table, Value, share, table
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.wording import interval_text, percent, reasoner_text

WHAT = (
    "Safe: no drive that went on with the action ended badly for the CAV. Acceptable: safe, without a PET below 1.5 s, "
    "and within 0.5 s of the best, in the time that all vehicles lose together. Pairs: of CAVs, where the order that "
    "was given is acceptable likewise. Drivers: judged as they then did. Unanswered questions count as wrong."
)

SAME = "Same: of the questions that were asked again, those that were answered the same."

CONTROL = "control"  # How the name of a control in a model's place begins


@dataclass(frozen=True, slots=True)
class ExamRow:
    """One who was examined."""

    reasoner: str
    counts: Mapping[str, float]
    seconds: float  # From the first question to the last answer [s]
    epochs: int = 1

    def rate(self, part: str, whole: str) -> float | None:
        """Return a share; None of none."""
        return share(int(self.counts.get(part, 0)), int(self.counts.get(whole, 0)))

    def per_question(self, *names: str) -> float | None:
        """Return a number of each request that was asked; None if none was."""
        asked = self.counts.get("asked", 0)
        return sum(self.counts.get(f"model {name}", 0) for name in names) / asked if asked else None

    @property
    def forms(self) -> str:
        """The forms in which the answers were asked for."""
        return ", ".join(sorted(name.removeprefix("form ") for name in self.counts if name.startswith("form ")))

    def interval(self) -> tuple[float, float] | None:
        """Return the 95 % interval of the share of acceptable actions."""
        whole = int(self.counts.get("situations", 0))
        return wilson_interval(int(self.counts.get("acceptable", 0)), whole) if whole else None


def exam_table(rows: Sequence[ExamRow]) -> Table:
    """Make the table."""

    def counter(name: str) -> Column[ExamRow]:
        return Column(name, lambda row: int(row.counts.get(name, 0)))

    def rate(key: str, head: str, part: str, whole: str, rank: int = 0) -> Column[ExamRow]:
        return Column(key, lambda row: row.rate(part, whole), head, _dash, rank=rank)

    def end(which: int) -> Callable[[ExamRow], Value]:
        return lambda row: found[which] if (found := row.interval()) else None

    return table(
        [
            Column("reasoner", lambda row: row.reasoner, words=True),
            Column("model", lambda row: reasoner_text(row.reasoner), "model", words=True, csv=False),
            *map(counter, ("questions", "situations", "pairs", "drivers", "asked")),
            rate("safe_rate", "safe", "safe", "situations"),
            rate("acceptable_rate", "acceptable", "acceptable", "situations"),
            Column("acceptable_low", end(0)),
            Column("acceptable_high", end(1)),
            Column("interval", lambda r: interval_text(r.interval()), "95 %", csv=False, rank=6),
            rate("best_rate", "best", "best", "situations", 5),
            rate("pairs_acceptable_rate", "pairs", "pairs_acceptable", "pairs"),
            rate("drivers_right_rate", "drivers", "drivers_right", "drivers"),
            rate("in_form_rate", "in form", "in_form", "asked", 2),
            Column("forms", lambda row: row.forms or None, "form", lambda v: str(v or "-"), words=True, rank=7),
            rate("unusable_rate", "unusable", "unusable", "asked", 4),
            Column("epochs", lambda row: row.epochs),
            Column("same_rate", lambda row: row.rate("same", "again"), "same", percent, sparse=True, rank=1),
            Column(
                "tokens", lambda r: r.per_question("prompt_tokens", "completion_tokens"), "tokens a request", _whole
            ),
            Column("request_seconds", lambda r: r.per_question("model_seconds"), "s a request", _seconds, rank=3),
            Column("cost_usd", lambda row: row.counts.get("model cost_usd"), "USD", _money, sparse=True, rank=3),
            Column("seconds", lambda row: row.seconds, "s in all", _whole, rank=4),
        ],
        rows,
    )


def print_exam(rows: Sequence[ExamRow], notes: Sequence[str]) -> PrintedTable:
    """Prepare the table for people."""
    further = [WHAT, *([SAME] if any(row.epochs > 1 for row in rows) else []), *notes]
    return printed("exam", exam_table(rows), [row.reasoner.startswith(CONTROL) for row in rows], further)


def _dash(value: Value) -> str:
    return percent(value) or "-"


def _whole(value: Value) -> str:
    return "-" if value is None else f"{float(value):,.0f}"


def _seconds(value: Value) -> str:
    return "-" if value is None else f"{float(value):.2f}"


def _money(value: Value) -> str:
    return "-" if not value else f"{float(value):.4f}"
