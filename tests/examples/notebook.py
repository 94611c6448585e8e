"""Runs the cells of a notebook and stores what they give: ``python tests/examples/notebook.py FILE...``."""

import ast
import base64
import contextlib
import io
import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

WIDTH = "100"  # Of a terminal, for what is printed [characters]


def read(path: Path) -> dict[str, Any]:
    """Read a notebook."""
    return json.loads(path.read_text(encoding="utf-8"))  # type: ignore[no-any-return]


def source(cell: dict[str, Any]) -> str:
    """The code or text of a cell."""
    return "".join(cell["source"])


def run(notebook: dict[str, Any], folder: Path) -> list[list[dict[str, Any]]]:
    """Run all cells in a folder; gives the outputs of each cell with code, in the form of the notebook."""
    space: dict[str, Any] = {"__name__": "__main__"}
    before, columns = Path.cwd(), os.environ.get("COLUMNS")
    os.chdir(folder)
    os.environ["COLUMNS"] = WIDTH
    try:
        codes = [source(cell) for cell in notebook["cells"] if cell["cell_type"] == "code"]
        return [_outputs(code, number, space) for number, code in enumerate(codes, 1)]
    finally:
        os.chdir(before)
        os.environ.pop("COLUMNS")
        if columns is not None:
            os.environ["COLUMNS"] = columns


def _outputs(code: str, number: int, space: dict[str, Any]) -> list[dict[str, Any]]:
    tree = ast.parse(code)
    shown = ast.Expression(tree.body.pop().value) if tree.body and isinstance(tree.body[-1], ast.Expr) else None  # type: ignore[attr-defined]
    said = io.StringIO()
    name = f"cell {number}"
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(io.StringIO()):
        exec(compile(tree, name, "exec"), space)
        value = eval(compile(shown, name, "eval"), space) if shown else None
    found: list[dict[str, Any]] = []
    if said.getvalue():
        found.append({"name": "stdout", "output_type": "stream", "text": said.getvalue().splitlines(keepends=True)})
    if value is not None:
        data = {"text/plain": repr(value).splitlines(keepends=True)}
        if (page := getattr(value, "_repr_html_", lambda: None)()) is not None:
            data["text/html"] = page.splitlines(keepends=True)
        if (picture := getattr(value, "_repr_png_", lambda: None)()) is not None:
            data["image/png"] = [base64.b64encode(picture).decode()]
        found.append({"data": data, "execution_count": number, "metadata": {}, "output_type": "execute_result"})
    return found


def store(path: Path) -> None:
    """Run a notebook in an empty folder and store its outputs in it."""
    notebook = read(path)
    with tempfile.TemporaryDirectory() as folder:
        outputs = iter(run(notebook, Path(folder)))
    number = 0
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            number += 1
            cell["execution_count"], cell["outputs"] = number, next(outputs)
    path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    for argument in sys.argv[1:]:
        store(Path(argument).resolve())
