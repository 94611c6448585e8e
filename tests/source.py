"""The source of the program, read for the conventions: files, imports, classes, lines."""

import ast
import re
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
PACKAGE = REPOSITORY / "codriving"


@dataclass(frozen=True)
class File:
    """One file of the program."""

    path: Path

    def __str__(self) -> str:
        return str(self.path.relative_to(REPOSITORY))

    @property
    def room(self) -> str:
        """Name of the room, or of the single file, in which it stands."""
        return self.path.relative_to(PACKAGE).parts[0].removesuffix(".py")

    @property
    def module(self) -> str:
        """Full name."""
        return ".".join(self.path.relative_to(REPOSITORY).with_suffix("").parts).removesuffix(".__init__")

    @cached_property
    def text(self) -> str:
        """The source."""
        return self.path.read_text(encoding="utf-8")

    @cached_property
    def nodes(self) -> list[ast.AST]:
        """Every node of its tree."""
        return list(ast.walk(ast.parse(self.text)))

    @cached_property
    def imports(self) -> list[tuple[str, str]]:
        """Module and name of everything that it imports, wherever in it; the name is empty if all of the module is."""
        found = []
        for node in self.nodes:
            if isinstance(node, ast.Import):
                found += [(alias.name, "") for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                assert node.level == 0, f"{self}: write the full name of what is imported"
                found += [(node.module or "", alias.name) for alias in node.names]
        return found

    @cached_property
    def named(self) -> list[str]:
        """Modules that it names in texts, as those do that import by name."""
        texts = [n.value for n in self.nodes if isinstance(n, ast.Constant) and isinstance(n.value, str)]
        return [text for text in texts if re.fullmatch(r"codriving(\.\w+)+(:\w+)?", text)]

    @property
    def classes(self) -> list[str]:
        """Names of its classes and protocols."""
        return [node.name for node in self.nodes if isinstance(node, ast.ClassDef)]

    @cached_property
    def lines(self) -> int:
        """All lines."""
        return len(self.text.splitlines())

    @cached_property
    def docstrings(self) -> set[int]:
        """Numbers of the lines in docstrings."""
        found = set[int]()
        for node in self.nodes:
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) and node.body:
                first = node.body[0]
                if ast.get_docstring(node, clean=False) is not None:
                    found |= set(range(first.lineno, (first.end_lineno or first.lineno) + 1))
        return found

    @property
    def code(self) -> int:
        """Lines that are no docstring, comment or blank."""
        lines = (line.strip() for k, line in enumerate(self.text.splitlines(), 1) if k not in self.docstrings)
        return sum(bool(line) and not line.startswith("#") for line in lines)


@lru_cache
def files() -> tuple[File, ...]:
    """Every file of the program."""
    return tuple(File(path) for path in sorted(PACKAGE.rglob("*.py")))


@lru_cache
def modules() -> dict[str, File]:
    """Every file by its full name."""
    return {file.module: file for file in files()}


def rooms() -> list[str]:
    """Names of the rooms."""
    return sorted({file.room for file in files() if (PACKAGE / file.room).is_dir()})


@cache
def targets(file: File, texts: bool = True) -> frozenset[str]:
    """Return the full names of the files of ours that a file imports, or also names in a text."""
    found = set[str]()
    for name in (*(f"{module}.{name}".rstrip(".") for module, name in file.imports), *(file.named if texts else ())):
        module = name.partition(":")[0]
        while module and module not in modules():
            module = module.rpartition(".")[0]
        found.add(module)
    return frozenset(found - {"", file.module})
