"""Points of a sweep to checked configs, all of them before the first episode; a refusal names the cell it is about."""

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from codriving.config.compose import compose
from codriving.config.schema import ROOT
from codriving.config.sweep import Point
from codriving.config.validate import validate
from codriving.errors import ConfigError
from codriving.runs.redaction import MASK, redact

T = TypeVar("T")

SHARED = (*(name for name in ROOT if name not in ("plugins", "prompts")), "launcher")
"""What all cells of a run have in common; classes may belong to one scenario alone, templates to one cell."""


def composed(points: Sequence[Point], config_dir: Path | None = None) -> list[dict[str, Any]]:
    """Compose the config of every cell; one after another, since Hydra's state is global.

    Raises:
        ConfigError: If one cannot be composed, or what belongs to the run as a whole differs between cells.
    """
    configs = each_cell(points, points, lambda point: compose(point.overrides, config_dir))
    for point, config in zip(points, configs, strict=True):
        for key in SHARED:
            if config[key] != configs[0][key]:
                one, other = _plain(configs[0][key]), _plain(config[key])
                raise ConfigError(
                    f"{key} is {one} in the cell {cell_name(points[0])} and {other} in the cell {cell_name(point)}; "
                    f"it belongs to the run as a whole, so set {key} on the command line"
                )
    return configs


def validated(points: Sequence[Point], configs: Sequence[Mapping[str, Any]]) -> None:
    """Check every node of every cell by building it.

    Raises:
        ConfigError: With the full key, the rule, the value that broke it and the cell.
    """
    each_cell(points, configs, validate)


def each_cell(points: Sequence[Point], given: Sequence[Any], work: Callable[[Any], T]) -> list[T]:
    """Do the same for every cell.

    Raises:
        ConfigError: The first refusal, with the cell it is about, unless all cells are refused for one reason.
    """
    done: list[T] = []
    refusals: dict[int, ConfigError] = {}
    for index, item in enumerate(given):
        try:
            done.append(work(item))
        except ConfigError as err:
            refusals[index] = err
        if refusals and (done or len(set(map(str, refusals.values()))) > 1):
            break
    if not refusals:
        return done
    index, first = next(iter(refusals.items()))
    if len(refusals) == len(given) and len(set(map(str, refusals.values()))) == 1:
        raise first
    raise type(first)(f"in the cell {cell_name(points[index])}: {first}") from first


def cell_name(point: Point) -> str:
    """Name a cell by what tells it from the others."""
    masked = redact({key: _number(text) for key, text in point.swept.items()})
    shown = [f"{key}={MASK if masked[key] == MASK else text}" for key, text in point.swept.items()]
    return " ".join([*shown, *point.removed]) or "with nothing removed"


def _number(text: str) -> object:
    """A number as such: it gives nothing away, whatever its key is called."""
    try:
        return float(text)
    except ValueError:
        return text


def _plain(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value, default=str)
