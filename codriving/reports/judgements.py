"""What was judged of human drivers against what they did, in the columns of tables; only where a judge was chosen."""

from collections.abc import Iterable

from codriving.reports.columns import Column
from codriving.reports.results import CellResults
from codriving.reports.wording import percent, two_digits

JUDGED, DECIDED = (
    "judged",
    "judged_decided",
)  # Counters: what the driver did is known; and the answer was no unclear one

JUDGEMENT_NOTE = (
    "Judged right: share of the answers yields and goes that agree with who then passed first; Brier: mean "
    "squared error of the probability; lost: time for which CAVs were held up by drivers who then let them pass."
)


def _share(cell: CellResults, part: str, whole: str | None) -> float | None:
    """Give a counter as a share of another one; of the episodes for None."""
    if JUDGED not in cell.counters:
        return None
    counted = float(cell.counters.get(part) or 0.0)
    of = len(cell.records) if whole is None else float(cell.counters.get(whole) or 0.0)
    return counted / of if of else None


JUDGEMENTS: tuple[Column[CellResults], ...] = (
    Column("judged_accuracy", lambda c: _share(c, "judged_right", DECIDED), "judged right", percent, rank=5),
    Column("judged_brier", lambda c: _share(c, "judged_squares", JUDGED), "Brier", two_digits, rank=6),
    Column(
        "yields_but_went_rate", lambda c: _share(c, "yields_but_went", DECIDED), "yields, but went", percent, rank=9
    ),
    Column(
        "goes_but_yielded_rate", lambda c: _share(c, "goes_but_yielded", DECIDED), "goes, but let pass", percent, rank=9
    ),
    Column("seconds_lost_mean", lambda c: _share(c, "seconds_lost", None), "lost [s]", two_digits, rank=8),
)


def judgement_columns(cells: Iterable[CellResults]) -> tuple[Column[CellResults], ...]:
    """Give the columns of judgements, if any were made."""
    return JUDGEMENTS if any(JUDGED in cell.counters for cell in cells) else ()


def judgement_notes(cells: Iterable[CellResults]) -> list[str]:
    """Say what these columns are."""
    return [JUDGEMENT_NOTE] if any(JUDGED in cell.counters for cell in cells) else []
