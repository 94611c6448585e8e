"""``learn.*``: success against the number of past interactions, each paired with none on the same seeds."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from codriving.reports.columns import Column, Table, swept_columns, table
from codriving.reports.pairs import SIGNIFICANT, PairedCells, PairedRate, points
from codriving.reports.paper import LearningStatement
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.results import CellResults
from codriving.reports.summary import BY_KEY, CLAIM, NOTE, labels
from codriving.reports.wording import fixed, title, two_digits

NOTES = (
    "Gains are against the fewest interactions on the same seeds, with the exact McNemar test; recalled counts "
    "memories, reconsidered the decisions that they changed.",
    "Memories are of other seeds than the tests and do not change while these are driven.",
)


# What was done to a memory, in words.
CONTROLS = {
    "verdicts": "shuffled verdicts",
    "situations": "shuffled situations",
    "rule": "one rule",
    "elsewhere": "another site's",
}

CONTROL_NOTE = (
    "Controls are of the same memory. Shuffled: verdicts, or situations, are dealt out anew among its experiences. One "
    "rule: the action that was a mistake most often (both lane changes count as one) is never done if another is safe."
)

ELSEWHERE_NOTE = "Another site's: the memory that was built at the next of the sites is recalled from here."


@dataclass(frozen=True)
class LearningRow:
    """One cell of the tests."""

    cell: CellResults
    interactions: int
    setting: int  # Number of the setting that it was tested in
    shots: int
    # The cell of the same setting with the fewest interactions; None for that one itself.
    fewest: CellResults | None = None
    claim: str | None = None  # What the paper says of its scenario after so many interactions
    control: str = "none"  # What was done to the memory: ``verdicts``, ``situations``, ``rule`` or ``elsewhere``

    @property
    def is_control(self) -> bool:
        """Whether something was done to the memory, so that nothing that was learnt is left but what that leaves."""
        return self.control != "none"

    @property
    def words(self) -> str:
        """What was done to the memory, in words; empty if nothing was."""
        return CONTROLS.get(self.control, "")

    @cached_property
    def pairs(self) -> PairedCells | None:
        """The comparison with the fewest interactions on the same seeds."""
        return PairedCells(self.cell, self.fewest) if self.fewest else None

    @property
    def gain(self) -> str:
        """The gain in success, with its p-value."""
        return _gain(self.pairs.success) if self.pairs and self.pairs.driven else ""

    @property
    def clean_gain(self) -> str:
        """The gain in clean success, with its p-value; empty where that is not known."""
        return _gain(self.pairs.clean) if self.pairs and self.cell.judged and self.pairs.driven else ""


def _gain(rate: PairedRate) -> str:
    return f"{points(rate.difference)} ({fixed(rate.p, 3)})"


def learning_rows(cells: Sequence[LearningRow], paper: Sequence[LearningStatement]) -> list[LearningRow]:
    """Put beside each cell what it is compared with and what the paper says."""
    fewest = {row.setting: row.cell for row in reversed(cells)}
    claims = {(s.scenario, s.interactions): s.statement for s in reversed(paper)}
    return [
        replace(
            row,
            fewest=None if row.cell is fewest[row.setting] else fewest[row.setting],
            # The paper tests the full framework alone.
            claim=claims.get((row.cell.first.scenario, row.interactions))
            if row.cell.first.variant == "full" and row.cell.papers_setting and not row.is_control
            else None,
        )
        for row in cells
    ]


def learning_table(rows: Sequence[LearningRow], swept: Sequence[str] = ()) -> Table:
    """Make the table."""

    def cell(*keys: str) -> list[Column[Any]]:
        return [BY_KEY[key].of(lambda row: row.cell) for key in keys]

    def counted(name: str) -> Column[Any]:
        return Column(name, lambda row: row.cell.counters.get(name), name, lambda value: str(value or 0), rank=8)

    def gain(key: str, value: Any) -> Column[Any]:  # noqa: ANN401 - of the pairs
        return Column(key, lambda row: value(row.pairs) if row.pairs else None)

    columns: list[Column[Any]] = [
        *(
            column.of(lambda row: row.cell)
            for column in (*labels([row.cell for row in rows], scenario=True), *swept_columns(swept))
        ),
        Column("interactions", lambda row: row.interactions, "interactions"),
        Column(
            "control",
            lambda row: row.words,
            "control",
            words=True,
            csv=any(row.is_control for row in rows),
            sparse=True,
        ),
        Column("shots", lambda row: row.shots),
        *(replace(column, head="") for column in cell("memory")),
        *cell("episodes", "completed", "count", "success_rate", "success_low", "success_high", "interval"),
        Column("gain", lambda row: row.gain, "gain [points] (p)", csv=False, rank=1, brief=("gain [points]", " (")),
        *cell("clean"),
        Column("clean_gain", lambda row: row.clean_gain, "clean gain (p)", csv=False, sparse=True, rank=2),
        *cell("clean_rate", "clean_low", "clean_high"),
        *cell("collision_rate", "timeout_rate"),
        Column("time_all", lambda row: row.cell.numbers.get("time_all"), "time of all [s]", fixed, sparse=True, rank=5),
        replace(*cell("pet_mean"), head="PET mean [s]", text=fixed, rank=5),
        *cell("pet_below_1_5"),
        replace(*cell("velocity_mean"), head="velocity [m/s]", text=two_digits, rank=4),
        counted("recalled"),
        counted("reconsidered"),
        gain("success_gain", lambda pairs: pairs.success.difference),
        gain("seeds_gained", lambda pairs: pairs.success.gained),
        gain("seeds_lost", lambda pairs: pairs.success.lost),
        gain("mcnemar_p", lambda pairs: pairs.success.p),
        gain("velocity_gain", lambda pairs: pairs.velocity.mean),
        gain("velocity_gain_low", lambda pairs: pairs.velocity.low),
        gain("velocity_gain_high", lambda pairs: pairs.velocity.high),
        gain("clean_difference", lambda pairs: pairs.clean.difference),
        gain("clean_mcnemar_p", lambda pairs: pairs.clean.p),
        Column("paper", lambda row: row.claim, CLAIM, words=True, rank=3),
    ]
    return table(columns, rows)


def print_learning(rows: Sequence[LearningRow], metrics: str, swept: Sequence[str] = ()) -> PrintedTable:
    """Prepare the table for people."""
    firsts = [row.cell.first for row in rows]
    heading = title("learning", [first.scenario for first in firsts], [first.reasoner for first in firsts], metrics)
    noted = [CONTROL_NOTE] if any(row.is_control for row in rows) else []
    noted += [ELSEWHERE_NOTE] if any(row.control == "elsewhere" for row in rows) else []
    notes = (NOTE, *NOTES, *noted, _shown([row for row in rows if not row.is_control], swept))
    return printed(heading, learning_table(rows, swept), [_setting(row, swept) for row in rows], notes)


def _setting(row: LearningRow, swept: Sequence[str]) -> tuple[object, ...]:
    first = row.cell.first
    return (first.scenario, first.variant, first.reasoner, *(row.cell.swept.get(key) for key in swept))


def _shown(rows: Sequence[LearningRow], swept: Sequence[str]) -> str:
    """Say where the most interactions are shown to differ from the fewest, and that nothing is shown elsewhere."""
    shown, several = [], len({row.cell.first.reasoner for row in rows}) > 1
    for row in {_setting(row, swept): row for row in rows}.values():
        gain, p = (row.pairs.success.difference, row.pairs.success.p) if row.pairs else (None, None)
        if gain is not None and p is not None and p < SIGNIFICANT:
            how, first = "raise" if gain > 0 else "lower", row.cell.first
            named = ", ".join(filter(None, (first.variant, first.reasoner if several else "")))
            shown.append(f"{row.interactions} interactions {how} success in {first.scenario} ({named})")
    if not shown:
        return "In no setting is a difference in success between the most and the fewest interactions shown (p < 0.05)."
    return f"Shown (p < 0.05): {'; '.join(shown)}. Elsewhere no difference in success is shown."
