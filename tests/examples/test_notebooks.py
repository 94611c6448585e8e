"""The notebooks of examples/: what is stored in them is what their cells give."""

import sys
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from notebook import read, run, source

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
NOTEBOOKS = sorted(EXAMPLES.glob("*.ipynb"))


def without_pictures(outputs: list[dict[str, Any]]) -> list[Any]:
    """What is compared: of a picture that it is one, since its bytes are those of one version of Matplotlib."""
    found = []
    for output in outputs:
        data = output.get("data", {})
        found.append(output.get("text") or {kind: data[kind] for kind in data if kind != "image/png"})
        found += [picture.startswith("iVBORw0KGgo") for picture in data.get("image/png", [])]
    return found


def test_there_are_two() -> None:
    assert [path.name for path in NOTEBOOKS] == ["method_of_your_own.ipynb", "paper_table.ipynb"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_what_is_stored_is_what_the_cells_give(path: Path, tmp_path: Path) -> None:
    notebook = read(path)
    stored = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert [cell["execution_count"] for cell in stored] == list(range(1, len(stored) + 1))
    for cell, outputs in zip(stored, run(notebook, tmp_path), strict=True):
        assert without_pictures(cell["outputs"]) == without_pictures(outputs), source(cell)
    shown = [kind for cell in stored for output in cell["outputs"] for kind in output.get("data", {})]
    assert "text/html" in shown
    assert "image/png" in shown
