"""Where names of release 0.1 are now, for plug-ins and YAMLs that were written for it; to go with release 0.3."""

import ast
import re
import traceback
from collections.abc import Iterator
from pathlib import Path

from codriving.config.locate import PACKAGE

FACES = ("scenarios", "ordering")  # Modules from which plug-ins are meant to import; what these offer is named by them

RENAMED = {"Entrant": "ApproachingVehicle", "Metrics": "Metric", "Reasoner": "Model"}  # Names that were changed, too


def new_place(name: str) -> str | None:
    """Find where a class, function or constant of ours is now."""
    name = RENAMED.get(name, name)
    for face in FACES:
        if f'    "{name}",' in (PACKAGE / f"{face}.py").read_text(encoding="utf-8"):
            return f"codriving.{face}.{name}"
    defined = re.compile(rf"^(?:class|def) {re.escape(name)}\b|^{re.escape(name)}\b[^=\n]* = ", re.MULTILINE)
    found = [p for p in sorted(PACKAGE.rglob("*.py")) if defined.search(p.read_text(encoding="utf-8"))]
    if len(found) != 1:
        return None
    parts = found[0].relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join([*(part for part in parts if part != "__init__"), name])


def moved_imports(err: ImportError) -> str:
    """Say in one line what a plug-in imports from an old place, and where each name is now."""
    if err.name is None or not err.name.startswith("codriving."):
        return ""
    frames = [frame for frame in traceback.extract_tb(err.__traceback__) if not frame.filename.startswith("<")]
    file = Path(frames[-1].filename)
    names = () if PACKAGE in file.parents else _imported(file, err.name)
    places = [f"{name} ({new_place(name) or 'gone'})" for name in names]
    if not places:
        return ""
    return f"{file} imports from {err.name}, which is not where it was in release 0.1: {', '.join(places)}"


def _imported(file: Path, module: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module == module:
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name == module)
