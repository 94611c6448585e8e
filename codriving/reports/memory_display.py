"""What is in a memory, as people read it: a table of built files, the contents of one, the hits of a search."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from codriving.reports.display import Display, Line
from codriving.reports.wording import reasoner_text

if TYPE_CHECKING:
    from codriving.memory.reading import Reading

VERDICTS = ("intensified", "eased", "too cautious")


@dataclass(frozen=True, slots=True)
class Built:
    """One memory that was built."""

    scenario: str
    method: str
    reasoner: str
    swept: Mapping[str, str]
    reading: "Reading"


def built_display(rows: Sequence[Built]) -> Display:
    """Prepare the table of memories that were built."""
    swept = tuple(dict.fromkeys(key for row in rows for key in row.swept))
    words = ("scenario", "method", *swept, "snapshot", "file")
    columns = (
        "scenario", "method", *swept, "interactions", "experiences", "made", *VERDICTS, "snapshot", "file",
    )  # fmt: skip
    lines = []
    for row in rows:
        kept, verdicts = row.reading.recollection.kept, row.reading.verdicts
        texts = {
            "scenario": row.scenario,
            "method": row.method,
            **row.swept,
            "interactions": str(len(row.reading.interactions)),
            "experiences": str(len(kept)),
            "made": str(sum(entry.count for entry in kept)),
            **{v: str(sum(n for (verdict, _), n in verdicts.items() if verdict == v)) for v in VERDICTS},
            "snapshot": row.reading.recollection.digest[:12],
            "file": str(row.reading.path),
        }
        lines.append(Line(tuple(texts.get(column, "") for column in columns)))
    reasoners = ", ".join(dict.fromkeys(reasoner_text(row.reasoner) for row in rows))
    notes = (
        "An experience is kept once, however often it was made. Recall from it with memory=frozen memory.file=FILE.",
    )
    return Display(f"memory - reasoner: {reasoners}", columns, words, tuple(lines), notes)
