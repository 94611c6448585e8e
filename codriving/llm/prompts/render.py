"""Templates in files, filled in by Jinja2; a user's folder replaces ours file by file."""

from collections.abc import Mapping
from functools import lru_cache
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from codriving.errors import ConfigError
from codriving.llm.prompts.example import example
from codriving.llm.question import Message

if TYPE_CHECKING:
    from jinja2 import Environment, Template

OURS = Path(__file__).parent
ROLES = ("system", "user")
PURPOSES = ("negotiate", "decide", "reflect", "dilu", "dilu_reflect")
FILES = tuple(f"{purpose}.{role}.md.j2" for purpose in PURPOSES for role in ROLES)
"""The templates that there are."""


class Prompts:
    """The templates of one folder, checked and compiled.

    Args:
        folder: Folder of the user's templates; a file that is not in it is ours. None for ours alone.

    Raises:
        ConfigError: If a template is broken, names an unknown variable, or is called what no template is called.
    """

    def __init__(self, folder: str | None = None) -> None:
        from jinja2 import TemplateError

        environment = _environment()
        self._templates: dict[str, Template] = {}
        for name, path in _paths(folder).items():
            values = example(name.split(".")[0])
            self._templates[name] = _compiled(environment, path, values)
            try:
                self._templates[name].render(values)
            except (TemplateError, TypeError, ValueError, ArithmeticError, LookupError, AttributeError) as error:
                raise ConfigError(
                    f"{path}: it cannot be filled in: {error}; see docs/change-the-prompts.md for what there is"
                ) from error

    def messages(self, purpose: str, values: Mapping[str, Any]) -> tuple[Message, ...]:
        """Return the system and the user message of a question.

        Args:
            purpose: One of ``PURPOSES``.

        Raises:
            ConfigError: If a template cannot be filled in.
        """
        from jinja2 import TemplateError

        try:
            return tuple(
                Message(role, self._templates[f"{purpose}.{role}.md.j2"].render(values).strip()) for role in ROLES
            )
        except (TemplateError, TypeError, ValueError, ArithmeticError, LookupError, AttributeError) as error:
            raise ConfigError(f"the template of {purpose} cannot be filled in: {error}") from error


@lru_cache(maxsize=8)
def load_prompts(folder: str | None) -> Prompts:
    """Return the templates of a folder; they are read once.

    Args:
        folder: Folder of the user's templates, or None.

    Raises:
        ConfigError: If a template cannot be used.
    """
    return Prompts(folder)


def _paths(folder: str | None) -> dict[str, Path]:
    """Say for each template which file it is."""
    if folder is None:
        return {name: OURS / name for name in FILES}
    theirs = Path(folder).expanduser()
    if not theirs.is_dir():
        raise ConfigError(f"llm.prompts={folder}: there is no such folder")
    unknown = sorted(path.name for path in theirs.glob("*.j2") if path.name not in FILES)
    if unknown:
        raise ConfigError(f"llm.prompts={folder}: {unknown[0]} is no template; there are {', '.join(FILES)}")
    if not any((theirs / name).is_file() for name in FILES):
        raise ConfigError(f"llm.prompts={folder}: the folder holds none of {', '.join(FILES)}")
    return {name: theirs / name if (theirs / name).is_file() else OURS / name for name in FILES}


def _environment() -> "Environment":
    from jinja2 import Environment, StrictUndefined

    made = Environment(undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, autoescape=False)
    made.filters.update({"m": _metres, "s": _seconds, "mps": _speed, "after": _after})
    return made


def _compiled(environment: "Environment", path: Path, values: Mapping[str, Any]) -> "Template":
    from jinja2 import TemplateSyntaxError
    from jinja2.meta import find_undeclared_variables

    try:
        source = path.read_text(encoding="utf-8")
        unknown = sorted(find_undeclared_variables(environment.parse(source)) - values.keys())
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: the template cannot be read: {error}") from error
    except TemplateSyntaxError as error:
        raise ConfigError(f"{path}, line {error.lineno}: {error.message}") from error
    if unknown:
        raise ConfigError(f"{path}: there is no variable {unknown[0]!r}; there are {', '.join(sorted(values))}")
    return environment.from_string(source)


def _metres(value: float) -> str:
    return f"{round(value)} m"


def _speed(value: float) -> str:
    return f"{abs(value):.1f} m/s"


def _seconds(value: float) -> str:
    return f"{value:.1f} s" if isfinite(value) and value < 100 else "never"


def _after(value: float) -> str:
    return f"in {value:.1f} s" if isfinite(value) else "not within 10 s"
