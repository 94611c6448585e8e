"""Templates in files, filled in by Jinja2: one of our sets, or a user's folder that replaces them file by file."""

from collections.abc import Callable, Collection, Mapping
from functools import lru_cache
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from codriving.errors import ConfigError
from codriving.llm.prompts.example import EXAMPLES
from codriving.llm.question import Message

if TYPE_CHECKING:
    from jinja2 import Environment, Template

OURS = Path(__file__).parent
ROLES = ("system", "user")
PURPOSES = tuple(EXAMPLES)
FILES = tuple(f"{purpose}.{role}.md.j2" for purpose in PURPOSES for role in ROLES)  # The templates that there are

PIECES = "pieces.md.j2"  # What several of ours say, to be imported

SETS = ("informed", "planner")  # Sets that ship, each a folder here; the first one is taken where none is named
OF_A_SET = ("negotiate", "decide")  # What a set has templates of; those of all else belong to all sets

_POWER = 1_000  # Of larger numbers a template forms no power
_REPEATED = 100_000  # Longest text or list that a template makes by repeating one

_FILTERS: dict[str, Callable[[float], str]] = {
    "m": lambda metres: f"{round(metres)} m",
    "s": lambda seconds: f"{seconds:.1f} s" if isfinite(seconds) and seconds < 100 else "never",
    "mps": lambda speed: f"{abs(speed):.1f} m/s",
    "after": lambda seconds: f"in {seconds:.1f} s" if isfinite(seconds) else "not within 10 s",
}


class Prompts:
    """The templates of one set or folder, checked and compiled.

    Args:
        chosen: Name of a set, or folder of the user's templates; a file that is not in it is that of the first set.
            None for the first set.

    Raises:
        ConfigError: If a template is broken, names an unknown variable, or is called what no template is called.
    """

    def __init__(self, chosen: str | None = None) -> None:
        self.name, self.informed = prompts_name(chosen), chosen != SETS[1]
        environment = _sandbox()
        environment.filters.update(_FILTERS)
        self._templates: dict[str, Template] = {}
        for name, path in _paths(chosen).items():
            values = EXAMPLES[name.split(".")[0]]
            self._templates[name] = _compiled(environment, path, values)
            self._render(
                name, values, f"{path}: it cannot be filled in", "; see docs/change-the-prompts.md for what there is"
            )

    def messages(self, purpose: str, values: Mapping[str, Any]) -> tuple[Message, ...]:
        """Return the system and the user message of a question.

        Args:
            purpose: One of ``PURPOSES``.

        Raises:
            ConfigError: If a template cannot be filled in.
        """
        problem = f"the template of {purpose} cannot be filled in"
        return tuple(
            Message(role, self._render(f"{purpose}.{role}.md.j2", values, problem, "").strip()) for role in ROLES
        )

    def _render(self, name: str, values: Mapping[str, Any], problem: str, cure: str) -> str:
        try:
            return self._templates[name].render(values)
        except Exception as error:
            # Whatever a template of the user's raises is the template's fault.
            raise ConfigError(f"{problem}: {error or type(error).__name__}{cure}") from error


def _sandbox() -> "Environment":
    """Return where templates are filled in: passed on from one person to the next, they may write text and no more."""
    from jinja2 import FunctionLoader, StrictUndefined, TemplateNotFound
    from jinja2.exceptions import SecurityError
    from jinja2.sandbox import ImmutableSandboxedEnvironment

    class Sandbox(ImmutableSandboxedEnvironment):
        intercepted_binops = frozenset(["*", "**", "%"])

        def call_binop(self, context: Any, operator: str, left: Any, right: Any) -> Any:  # noqa: ANN401 - any values
            if operator == "%" and not isinstance(left, (int, float)):
                raise SecurityError("% on a text is not worked out here; write the parts one after another")
            if operator == "%":
                return super().call_binop(context, operator, left, right)
            sizes = [abs(value) if isinstance(value, (int, float)) else len(value) for value in (left, right)]
            repeats = not (isinstance(left, (int, float)) and isinstance(right, (int, float)))
            if (operator == "**" and max(sizes) > _POWER) or (repeats and sizes[0] * sizes[1] > _REPEATED):
                raise SecurityError(f"{operator} would make something too large")
            return super().call_binop(context, operator, left, right)

    def piece(name: str) -> str:
        if name != PIECES:
            raise TemplateNotFound(name, f"there is nothing to include or import but {PIECES}")
        return (OURS / PIECES).read_text(encoding="utf-8")

    return Sandbox(
        loader=FunctionLoader(piece), undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, autoescape=False
    )


@lru_cache(maxsize=8)
def load_prompts(chosen: str | None) -> Prompts:
    """Return the templates of a set or folder, see ``Prompts``; they are read once."""
    return Prompts(chosen)


def prompts_name(chosen: str | None) -> str:
    """Return what tables call a choice of prompts: the name of a set, or that of a folder."""
    return SETS[0] if chosen is None else chosen if chosen in SETS else Path(chosen).name or chosen


def template_files(chosen: str | None, purposes: Collection[str]) -> dict[str, Path]:
    """Return the files of the templates of some purposes, by what they are.

    Args:
        chosen: Name of a set, folder of the user's templates, or None.
    """
    paths = {name: path for name, path in _paths(chosen).items() if name.split(".")[0] in purposes}
    if any(PIECES in path.read_text(encoding="utf-8", errors="replace") for path in paths.values()):
        paths[PIECES] = OURS / PIECES
    return {f"template {name}": path for name, path in paths.items()}


def _paths(folder: str | None) -> dict[str, Path]:
    """Say for each template which file it is."""
    of = folder if folder in SETS else SETS[0]
    ours = {name: (OURS / of if name.split(".")[0] in OF_A_SET else OURS) / name for name in FILES}
    if folder is None or folder in SETS:
        return ours
    theirs = Path(folder).expanduser()
    if not theirs.is_dir():
        sets = " or ".join(SETS)
        raise ConfigError(f"llm.prompts={folder}: there is no such folder; name one, or {sets}")
    unknown = sorted(path.name for path in theirs.glob("*.j2") if path.name not in FILES)
    if unknown:
        raise ConfigError(f"llm.prompts={folder}: {unknown[0]} is no template; there are {', '.join(FILES)}")
    if not any((theirs / name).is_file() for name in FILES):
        raise ConfigError(f"llm.prompts={folder}: the folder holds none of {', '.join(FILES)}")
    return {name: theirs / name if (theirs / name).is_file() else ours[name] for name in FILES}


def _compiled(environment: "Environment", path: Path, values: Mapping[str, Any]) -> "Template":
    from jinja2 import TemplateSyntaxError
    from jinja2.meta import find_undeclared_variables

    try:
        source = path.read_text(encoding="utf-8")
        unknown = sorted(find_undeclared_variables(environment.parse(source)) - values.keys())
    except (OSError, UnicodeDecodeError, RecursionError) as error:
        raise ConfigError(f"{path}: the template cannot be read: {error}") from error
    except TemplateSyntaxError as error:
        raise ConfigError(f"{path}, line {error.lineno}: {error.message}") from error
    if unknown:
        raise ConfigError(f"{path}: there is no variable {unknown[0]!r}; there are {', '.join(sorted(values))}")
    return environment.from_string(source)
