"""What the paper says of learning, read from ``experiments/paper_learning.csv``."""

import csv
from dataclasses import dataclass
from pathlib import Path

LEARNING = "paper_learning.csv"


@dataclass(frozen=True, slots=True)
class LearningStatement:
    """One statement of the paper on its learning figure.

    Attributes:
        interactions: After how many interactions; None where it gives no number.
    """

    scenario: str
    interactions: int | None
    statement: str
    success: float | None


def read_learning(folder: Path) -> tuple[LearningStatement, ...]:
    """Read the paper's statements."""
    path = folder / LEARNING
    if not path.is_file():
        return ()
    with path.open(encoding="utf-8", newline="") as file:
        return tuple(
            LearningStatement(
                row["scenario"],
                int(row["interactions"]) if row["interactions"] else None,
                row["statement"],
                float(row["success"]) if row["success"] else None,
            )
            for row in csv.DictReader(file)
        )
