"""What a row of a comparison takes more than the bound of its scenes."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from codriving.reports.columns import Column
from codriving.reports.wording import fixed, two_digits

HEAD = "bound without human drivers"  # What the title of a table says that has these columns

PROVEN_NOTE = (
    "Arrival: mean a CAV over successful episodes. Above bound: that less the bound of the same seeds, a CAV and as a "
    "share; no way of driving is faster than the bound, in which human drivers are left out."
)

ALONE_NOTE = "Time alone ({names}): where CAVs choose their lanes, each CAV by itself stands in place of the bound."


@dataclass(frozen=True, slots=True)
class Above:
    """Means over the successful episodes of a row, or over all scenes for the bound itself."""

    arrival: float | None  # Arrival of a CAV [s]
    seconds: float | None  # The same less the bound [s]
    percent: float | None  # The same as a share of the bound [%]
    proven: bool  # Whether it is a bound of all CAVs together; else it is the time of each alone


def above_columns() -> list[Column[Any]]:
    """Give the columns, of what may have an `Above`."""
    columns: list[Column[Above]] = [
        Column("arrival_mean", lambda a: a.arrival, "arrival [s]", two_digits),
        Column("above_bound", lambda a: a.seconds, "above bound [s]", two_digits),
        Column("above_bound_percent", lambda a: a.percent, "above bound [%]", fixed),
    ]
    return [column.of(lambda row: row.above) for column in columns]


def above_notes(rows: Sequence[Any]) -> list[str]:
    """Say what the columns mean, if there are any."""
    found = [row for row in rows if row.above]
    alone = ", ".join(dict.fromkeys(row.scenario for row in found if not row.above.proven))
    return [*([PROVEN_NOTE] if found else []), *([ALONE_NOTE.format(names=alone)] if alone else [])]
