"""What this behaviour number drove is driven today: hashes of records, trajectories, prompts and memories."""

from pathlib import Path

import hashes
import pytest
from cells import CELLS, EPISODES, SEED, Cell
from driving import drive

GOLDEN = hashes.read()


def test_cells_and_golden_values_belong_together() -> None:
    names = [cell.name for cell in CELLS]
    assert names == list(GOLDEN)


@pytest.mark.parametrize("cell", CELLS, ids=lambda cell: cell.name.replace(" ", "-"))
def test_a_cell_is_driven_as_version_0_1_did(cell: Cell, tmp_path: Path) -> None:
    beyond = tuple(str(SEED + k) for k in range(cell.episodes, EPISODES))
    golden = [row for row in GOLDEN[cell.name] if not row["of"].endswith(beyond)]
    found = hashes.differences(cell.name, drive(cell, tmp_path), golden)
    assert not found, "\n".join(found)
