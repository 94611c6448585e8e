"""The table of memories that were built, as people read it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from codriving.reports.columns import Column, swept_columns, table
from codriving.reports.printed import PrintedTable, printed
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
    swept: Mapping[str, str]
    reading: "Reading"


def print_built(memories: Sequence[BuiltMemory]) -> PrintedTable:
    """Prepare the table."""
    columns: list[Column[BuiltMemory]] = [
        Column("scenario", lambda m: m.scenario, "scenario", words=True),
        Column("method", lambda m: m.method, "method", words=True),
        *swept_columns(dict.fromkeys(key for memory in memories for key in memory.swept)),
        Column("interactions", lambda m: len(m.reading.interactions), "interactions"),
        Column("experiences", lambda m: len(m.reading.snapshot.experiences), "experiences"),
        Column("made", lambda m: sum(entry.count for entry in m.reading.snapshot.experiences), "made"),
        *map(_effect, EFFECTS),
        Column("snapshot", lambda m: m.reading.snapshot.digest[:12], "snapshot", words=True),
        Column("file", lambda m: str(m.reading.path), "file", words=True),
    ]
    title = f"memory - reasoner: {', '.join(dict.fromkeys(reasoner_text(memory.reasoner) for memory in memories))}"
    note = "An experience is kept once, however often it was made. Recall from it with memory=frozen memory.file=FILE."
    return printed(title, table(columns, memories), [""] * len(memories), [note])


def _effect(effect: str) -> Column[BuiltMemory]:
    def experiences(memory: BuiltMemory) -> int:
        return sum(number for (found, _), number in memory.reading.verdicts.items() if found == effect)

    return Column(effect, experiences, effect)
