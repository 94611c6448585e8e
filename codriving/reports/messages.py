"""What CAVs tell one another, in the columns of tables; only where a channel is between them."""

from collections.abc import Iterable

from codriving.reports.columns import Column
from codriving.reports.results import CellResults
from codriving.reports.wording import two_digits

SENT, BYTES, AGE, USES = "messages", "message_bytes", "message_age", "message_uses"  # Counters


def _rate(cell: CellResults, counter: str, unit: float = 1.0) -> float | None:
    """Give how much of something all CAVs of an episode together send in a second of the world."""
    amount, seconds = cell.counters.get(counter), sum(record.outcome.time for record in cell.records)
    return float(amount) / unit / seconds if isinstance(amount, int | float) and seconds else None


def _age(cell: CellResults) -> float | None:
    """Give how old what a CAV knows by a message is when it decides by that [s], on average."""
    ages, uses = (float(cell.counters.get(counter) or 0.0) for counter in (AGE, USES))
    return ages / uses if uses else None


MESSAGES: tuple[Column[CellResults], ...] = (
    Column("messages_per_second", lambda c: _rate(c, SENT), "messages [1/s]", two_digits, rank=11),
    Column("kilobytes_per_second", lambda c: _rate(c, BYTES, 1000.0), "kB/s", two_digits, rank=10),
    Column("message_age_mean", _age, "age [s]", two_digits, rank=10),
)


def message_columns(cells: Iterable[CellResults]) -> tuple[Column[CellResults], ...]:
    """Give the columns of messages, if any were sent."""
    return MESSAGES if any(SENT in cell.counters for cell in cells) else ()
