"""``learn.csv``: success against the number of past interactions, each paired with none on the same seeds."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.pairs import paired
from codriving.reports.paper_learning import LearningStatement
from codriving.reports.rows import Row, Value
from codriving.reports.summary import summary_row

QUALITY = (
    "episodes", "completed", "success_rate", "success_low", "success_high", "collision_rate", "timeout_rate",
    "pet_mean", "pet_below_1_5", "velocity_mean", "recalled", "reconsidered",
)  # fmt: skip
"""Columns of the summary that the table takes over; the last two count memories and changed decisions."""

AGAINST = {
    "success_difference": "success_gain",
    "only_method_succeeds": "seeds_gained",
    "only_codriving_succeeds": "seeds_lost",
    "mcnemar_p": "mcnemar_p",
    "velocity_difference": "velocity_gain",
    "velocity_difference_low": "velocity_gain_low",
    "velocity_difference_high": "velocity_gain_high",
}
"""Columns of the paired comparison with no interactions, and what they are called here."""

TEXTS = ("scenario", "method", "variant", "reasoner", "memory", "paper")


@dataclass(frozen=True, slots=True)
class LearningCell:
    """One cell of the tests."""

    records: Sequence[EpisodeRecord]
    interactions: int
    setting: int
    swept: Mapping[str, str]
    shots: int


def learning_columns(swept: Sequence[str] = ()) -> tuple[str, ...]:
    """Give the columns of ``learn.csv``."""
    labels = ("scenario", "method", "variant", "reasoner", *swept, "interactions", "shots", "memory")
    return (*labels, *QUALITY, *AGAINST.values(), "paper")


def learning_rows(cells: Sequence[LearningCell], paper: Sequence[LearningStatement]) -> list[Row]:
    """Make the rows."""
    first: dict[int, LearningCell] = {}
    for cell in cells:
        first.setdefault(cell.setting, cell)
    return [_row(cell, first[cell.setting], paper) for cell in cells]


def _row(cell: LearningCell, first: LearningCell, paper: Sequence[LearningStatement]) -> Row:
    summary = summary_row(cell.records)
    against: dict[str, Value] = {}
    if cell is not first:
        pairs = paired(cell.records, first.records)
        against = {name: pairs[column] for column, name in AGAINST.items()}
    return {
        **{name: summary[name] for name in ("scenario", "method", "variant", "reasoner")},
        **cell.swept,
        "interactions": cell.interactions,
        "shots": cell.shots,
        "memory": summary.get("memory"),
        **{name: summary.get(name) for name in QUALITY},
        **against,
        "paper": _statement(str(summary["scenario"]), str(summary["variant"]), cell.interactions, paper),
    }


def _statement(scenario: str, variant: str, interactions: int, paper: Sequence[LearningStatement]) -> str | None:
    """What the paper says of this scenario after so many interactions; it tests the full framework alone."""
    if variant != "full":
        return None
    return next((s.statement for s in paper if (s.scenario, s.interactions) == (scenario, interactions)), None)
