"""How far the rows of a comparison are above the bound of their scenes, and the row of the bound itself."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from codriving.reports.columns import mean
from codriving.reports.comparison import Compared, setting_of
from codriving.reports.regret import Above
from codriving.reports.results import CellResults

BOUND = "bound"  # Name of its row

PROVEN, ALONE = "proven", "time alone"  # What its row says instead of who reasons


@dataclass(frozen=True, slots=True)
class SceneBounds:
    """The bounds of the seeds of one block."""

    totals: Mapping[int, float]  # Least sum of arrivals of each seed [s]
    cavs: int
    proven: bool  # Whether it is a bound of all CAVs together; else it is the time of each alone


def with_bounds(rows: Sequence[Compared], bounds: SceneBounds) -> list[Compared]:
    """Put the row of the bound before those of a block, and say of each by how much it is above."""
    first = next(row for row in rows if row.cell)
    own = Above(mean([total / bounds.cavs for total in bounds.totals.values()]), 0.0, 0.0, bounds.proven)
    status = PROVEN if bounds.proven else ALONE
    top = Compared(first.scenario, BOUND, status, swept=setting_of(first.swept), above=own)
    return [top, *(replace(row, above=above(row.cell, bounds)) if row.cell else row for row in rows)]


def above(cell: CellResults, bounds: SceneBounds) -> Above:
    """Say by how much the successes of a cell are above the bound of their seeds."""
    totals = [
        (sum(episode.record.outcome.arrivals.values()), bounds.totals[episode.record.seed])
        for episode in cell.successes
    ]
    return Above(
        mean([total / bounds.cavs for total, _ in totals]),
        mean([(total - least) / bounds.cavs for total, least in totals]),
        mean([100 * (total / least - 1) for total, least in totals]),
        bounds.proven,
    )
