"""Which cells are driven as in the paper, so that its numbers may stand beside them."""

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

from codriving.config import choices, compose
from codriving.datatypes import EpisodeRecord
from codriving.experiment.cells import Cell
from codriving.reports import CellResults

SEEDS = list(range(20))  # As in experiments/comparison.yaml; the paper drives 20 and does not name them


def results_of(
    cell: Cell, records: Sequence[EpisodeRecord], swept: Mapping[str, str], cpu: float | None = None
) -> CellResults:
    """Give the episodes of a cell to the tables."""
    setting = _is_papers_setting(cell)
    with_seeds = setting and [record.seed for record in records] == SEEDS
    repeatable = cell.repeatable is not False
    return CellResults(records, swept, cpu, cell.score_name, setting, with_seeds, cell.remark, repeatable)


def _is_papers_setting(cell: Cell) -> bool:
    """Whether scenario and number of vehicles are those of the shipped YAMLs, and the world is the paper's."""
    scenario = cell.labels.scenario
    # Looked at first, since a second config takes as long to compose as half an episode to drive.
    otherwise = cell.resolved.get("limits") is not None or cell.resolved.get("v2x") is not None
    if otherwise or _thinks(cell.resolved) or scenario not in choices("scenario"):
        return False
    return all(cell.resolved.get(key) == node for key, node in _shipped(scenario).items())


def _thinks(resolved: Mapping[str, Any]) -> bool:
    """Whether it takes time to think; the paper waits for its model."""
    thinking, llm = resolved.get("thinking") or {}, resolved.get("llm") or {}
    return bool(thinking.get("mind") or thinking.get("order")) or llm.get("latency", "none") != "none"


@cache
def _shipped(scenario: str) -> dict[str, Any]:
    config = compose([f"scenario={scenario}", "suite=paper"])
    return {key: config[key] for key in ("scenario", "environment")}
