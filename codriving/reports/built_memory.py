"""The table of memories that were built, as people read it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from codriving.reports.columns import Column, swept_columns, table
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.results import CellResults
from codriving.reports.summary import ASKED_COLUMNS, labels, model_notes
from codriving.reports.wording import reasoner_text

if TYPE_CHECKING:
    from codriving.memory import Reading

EFFECTS = ("intensified", "eased", "too cautious")


@dataclass(frozen=True, slots=True)
class BuiltMemory:
    """One memory that was built."""

    scenario: str
    method: str
    reasoner: str
    reading: "Reading"
    results: CellResults  # The episodes that were learnt from


def print_built(memories: Sequence[BuiltMemory]) -> PrintedTable:
    """Prepare the table."""
    results = [memory.results for memory in memories]
    swept = dict.fromkeys(key for cell in results for key in cell.swept)
    reasoner = [column for column in labels(results, scenario=True) if column.key == "reasoning"]
    columns: list[Column[Any]] = [
        Column("scenario", lambda m: m.scenario, "scenario", words=True),
        Column("method", lambda m: m.method, "method", words=True),
        *(column.of(lambda m: m.results) for column in (*reasoner, *swept_columns(swept))),
        Column("interactions", lambda m: len(m.reading.interactions), "interactions", rank=1),
        Column("experiences", lambda m: len(m.reading.snapshot.experiences), "experiences", rank=2),
        Column("made", lambda m: sum(entry.count for entry in m.reading.snapshot.experiences), "made", rank=6),
        *map(_effect, EFFECTS),
        *(column.of(lambda m: m.results) for column in (ASKED_COLUMNS if any(r.asked for r in results) else ())),
        Column("snapshot", lambda m: m.reading.snapshot.digest[:12], "snapshot", words=True, rank=7),
        Column("file", lambda m: str(m.reading.path), "file", words=True),
    ]
    title = f"memory - reasoner: {', '.join(dict.fromkeys(reasoner_text(memory.reasoner) for memory in memories))}"
    note = "An experience is kept once, however often it was made. Recall from it with memory=frozen memory.file=FILE."
    return printed(title, table(columns, memories), [""] * len(memories), [note, *model_notes(results)])


def _effect(effect: str) -> Column[BuiltMemory]:
    def experiences(memory: BuiltMemory) -> int:
        return sum(number for (found, _), number in memory.reading.verdicts.items() if found == effect)

    return Column(effect, experiences, effect, rank=5)
