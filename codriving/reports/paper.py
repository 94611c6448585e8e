"""The paper's own numbers and statements, read from ``experiments/*.csv``, to stand beside ours."""

import csv
from dataclasses import dataclass, replace
from pathlib import Path

COMPARISON = "paper_comparison.csv"
SINGLE_VEHICLE = "paper_single_vehicle.csv"
ABLATION = "paper_ablation.csv"
LEARNING = "paper_learning.csv"
SEEDS = 20  # Seeds of each row of the paper's comparison

WHOLE = frozenset({"", "full"})  # Variants of which nothing has been removed


@dataclass(frozen=True, slots=True)
class PaperRow:
    """One row of the paper's comparison, or of the authors' extra comparison of single-vehicle methods."""

    scenario: str  # Name of the scenario; the paper compares methods at the intersection alone
    method: str
    label: str
    reasoner: str  # ``model`` for a method that goes by a language model, else ``none``
    numbers: dict[str, float]
    episodes: int | None = SEEDS  # How many seeds it drove; None where that is not told


@dataclass(frozen=True, slots=True)
class PaperStatement:
    """What the paper says of one ablation."""

    scenario: str
    variant: str
    statement: str


@dataclass(frozen=True, slots=True)
class LearningStatement:
    """One statement of the paper on its learning figure."""

    scenario: str
    interactions: int | None  # After how many interactions; None where it gives no number
    statement: str
    success: float | None


@dataclass(frozen=True, slots=True)
class Paper:
    """Everything of the paper that tables quote."""

    comparison: tuple[PaperRow, ...] = ()
    ablation: tuple[PaperStatement, ...] = ()
    single_vehicle: tuple[PaperRow, ...] = ()

    def row(self, scenario: str, method: str, variant: str) -> PaperRow | None:
        """Find the paper's row for one of ours."""
        if variant not in WHOLE:
            return None
        rows = (*self.comparison, *self.single_vehicle)
        return next((row for row in rows if (row.scenario, row.method) == (scenario, method)), None)

    def statement(self, scenario: str, variant: str) -> str:
        """Find what the paper says of an ablation."""
        removed = variant if variant in WHOLE else variant.partition("/")[0]
        if removed in WHOLE and variant not in WHOLE:
            return ""
        return next((s.statement for s in self.ablation if (s.scenario, s.variant) == (scenario, removed)), "")


def read_paper(folder: Path) -> Paper:
    """Read the paper's numbers."""
    return Paper(
        tuple(map(_row, _read(folder / COMPARISON))),
        tuple(PaperStatement(row["scenario"], row["variant"], row["statement"]) for row in _read(folder / ABLATION)),
        tuple(replace(_row(row), episodes=None) for row in _read(folder / SINGLE_VEHICLE)),
    )


def read_learning(folder: Path) -> tuple[LearningStatement, ...]:
    """Read the paper's statements on learning."""
    return tuple(
        LearningStatement(
            row["scenario"],
            int(row["interactions"]) if row["interactions"] else None,
            row["statement"],
            float(row["success"]) if row["success"] else None,
        )
        for row in _read(folder / LEARNING)
    )


def _read(path: Path) -> list[dict[str, str]]:
    if not path.is_file():
        return []
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def _row(texts: dict[str, str]) -> PaperRow:
    words = ("scenario", "method", "label", "reasoner")
    numbers = {name: float(text) for name, text in texts.items() if name not in words and text}
    return PaperRow(texts["scenario"], texts["method"], texts["label"], texts.get("reasoner", "none"), numbers)
