"""``load.csv``: one row a method and scenario, with success and velocity at each number of CAVs."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from codriving.reports.comparison import DRIVEN, METHOD_CHOICE, MISSING, Entry, takes_place_of
from codriving.reports.model_columns import FALLBACK_RATE
from codriving.reports.rows import Row, Value
from codriving.reports.summary import summary_row

AT_EACH = (
    "completed",
    "success_rate",
    "success_low",
    "success_high",
    "pet_mean",
    "pet_below_1_5",
    "velocity_mean",
)
"""What is given at each number of CAVs."""


@dataclass(frozen=True, slots=True)
class Loaded:
    """One row of the table of loads.

    Attributes:
        cpu: CPU time of a decision at each number of CAVs [s], or None.
    """

    labels: Row
    at: dict[int, Row] = field(default_factory=dict)
    cpu: dict[int, float | None] = field(default_factory=dict)

    @property
    def model(self) -> bool:
        """Whether a language model reasons."""
        return any(FALLBACK_RATE in row for row in self.at.values())

    def row(self) -> Row:
        """Give its columns in ``load.csv``."""
        measured = {
            f"{name}_{cavs}": row[name]
            for cavs, row in self.at.items()
            for name in (*AT_EACH, FALLBACK_RATE)
            if name in row
        }
        return {**self.labels, "episodes": next((row["episodes"] for row in self.at.values()), None), **measured}


def load_columns(loads: Sequence[int], swept: Sequence[str] = (), model: bool = False) -> tuple[str, ...]:
    """Give the columns of ``load.csv``."""
    at_each = (*AT_EACH, *([FALLBACK_RATE] if model else []))
    labels = ("scenario", "method", "variant", "reasoner", "status")
    return (*labels, *swept, "episodes", *(f"{name}_{cavs}" for name in at_each for cavs in loads))


def load_rows(cells: Sequence[tuple[int, Entry]], methods: Sequence[str]) -> list[Loaded]:
    """Put the cells of one method and setting into a row.

    Returns:
        The rows: those of a scenario and setting together, ``methods`` in their order, then all others as they come.
    """
    settings: dict[tuple[Value, ...], dict[tuple[Value, ...], Loaded]] = {}
    for cavs, entry in cells:
        summary = summary_row(entry.records)
        labels = {name: summary[name] for name in ("scenario", "method", "variant", "reasoner")}
        setting = settings.setdefault((summary["scenario"], *entry.setting.values()), {})
        which = (*labels.values(), entry.swept.get(METHOD_CHOICE))
        row = setting.setdefault(which, Loaded({**labels, "status": DRIVEN, **entry.swept}))
        row.at[cavs], row.cpu[cavs] = summary, entry.cpu
    return [row for setting in settings.values() for row in _in_order(list(setting.values()), methods)]


def _in_order(rows: Sequence[Loaded], methods: Sequence[str]) -> list[Loaded]:
    kept = {name: value for name, value in rows[0].labels.items() if name not in ("variant", "reasoner", METHOD_CHOICE)}
    ordered: list[Loaded] = []
    for method in methods:
        found = [row for row in rows if takes_place_of(str(row.labels["method"])) == method]
        ordered += found or [Loaded({**kept, "method": method, "status": MISSING})]
    return [*ordered, *(row for row in rows if takes_place_of(str(row.labels["method"])) not in methods)]
