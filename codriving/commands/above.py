"""The bounds of the scenes of a comparison, solved once a seed and kept in the run folder."""

from collections.abc import Sequence
from pathlib import Path

from codriving.commands.bounds import ENVELOPES, KeptBounds, world_of
from codriving.errors import ConfigError
from codriving.experiment import Cell
from codriving.reports import METHOD_CHOICE, CellResults, Compared, SceneBounds, with_bounds


class BoundsOfRun:
    """Bounds all blocks of a comparison.

    Attributes:
        notes: Why blocks have no bound.
    """

    def __init__(self, folder: Path) -> None:
        self._kept = KeptBounds.of(folder)
        self.notes: tuple[str, ...] = ()

    def over(self, rows: Sequence[Compared], block: Sequence[tuple[Cell, CellResults]]) -> list[Compared]:
        """Say of the rows of a block by how much they are above its bound; as they are where none is defined."""
        resolved = block[0][0].resolved
        seeds = sorted({record.seed for _, results in block for record in results.records})
        try:
            world, mark = world_of(resolved, Path(resolved["output"]) / ENVELOPES)
            solved = {seed: self._kept.row(world, mark, seed) for seed in seeds}
        except ConfigError as refusal:
            told = [f"{key}={value}" for key, value in block[0][1].swept.items() if key != METHOD_CHOICE]
            where = f" at {', '.join(told)}" if told else ""
            self.notes = tuple(dict.fromkeys((*self.notes, f"Above bound is empty{where}: {refusal}.")))
            return list(rows)
        totals = {seed: float(row["bound"]) for seed, row in solved.items()}
        cavs = int(next(iter(solved.values()))["cavs"])
        return with_bounds(rows, SceneBounds(totals, cavs, world.envelopes is not None))
