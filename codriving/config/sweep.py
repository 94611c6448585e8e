"""One command, many configs: keys with several values, in every combination and in the order given."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice, product
from math import prod
from pathlib import Path
from typing import Any

from codriving.config.choices import ALL, LISTED, SUITE, check_config_dir, choices
from codriving.config.given import Given
from codriving.config.overrides import (
    TEXT_WITH_COMMAS,
    check_choice,
    choice_named,
    may_be_secret,
    parse,
    shown,
    written,
)
from codriving.config.schema import ROOT
from codriving.config.suites import members, suite_sets
from codriving.errors import ConfigError

MOST = 1000  # Configs of one command; more than these are a slip of the keyboard

# What belongs to the run as a whole, and why it cannot differ between its cells.
ONE_VALUE = {
    "run": "a sweep is one run under one name",
    "output": "all cells of a run are written under one folder",
    "experiment": "all cells of a run belong to one experiment",
    "experiments": "each is a table of its own, so run them one after another",
    **dict.fromkeys(("episodes", "seed"), "all cells drive the same seeds, so that their rows can be compared"),
    **dict.fromkeys(("workers", "launcher"), "all cells share the processes, and no result depends on them"),
    "prompts": "templates belong to a model, whose llm.prompts takes several",
    "plugins": "it holds a list already, as in plugins=[a,b]",
    "shard": "each process drives one",
    "render": "it changes no result",
}


@dataclass(frozen=True)
class Point:
    """One config of a sweep."""

    overrides: tuple[str, ...]
    swept: Mapping[str, str] = field(default_factory=dict)
    removed: tuple[str, ...] = ()
    given: Given | None = None  # What stands in the place of the method that the overrides name


@dataclass(frozen=True)
class _Axis:
    """A token and, by their value, the tokens with one value each that it stands for."""

    token: str
    key: str
    tokens: dict[str, str]


def expand(tokens: Sequence[str], config_dir: Path | None = None) -> tuple[Point, ...]:
    """Take keys with several values apart: the first such key varies slowest.

    Several values are ``a,b``, ``choice(a,b)``, ``range(4,10,2)``, for a group also ``all`` and ``glob(m*)``, and for
    suites the name of a set. A quoted text and a list in brackets are one value.

    Args:
        tokens: ``key=value`` as typed.

    Raises:
        ConfigError: If a token cannot be read, or a key cannot have several values.
    """
    if config_dir is not None:
        check_config_dir(config_dir)
    axes = [_axis(token, config_dir) for token in written(tokens)]
    several = [axis for axis in axes if len(axis.tokens) > 1]
    for axis in several:
        if sum(other.key == axis.key for other in axes) > 1:
            raise ConfigError(f"{shown(axis.token)}: {axis.key} is given again beside its several values; give it once")
    if prod(len(axis.tokens) for axis in axes) > MOST:
        asked = " ".join(shown(axis.token) for axis in several)
        raise ConfigError(f"{asked} asks for more than {MOST} cells; a run has no more, so make several of it")
    return tuple(
        Point(
            tuple(axis.tokens[value] for axis, value in zip(axes, chosen, strict=True)),
            {axis.key: value for axis, value in zip(axes, chosen, strict=True) if axis in several},
        )
        for chosen in product(*(axis.tokens for axis in axes))
    )


def _axis(token: str, config_dir: Path | None) -> _Axis:
    override = parse(token)
    key = override.key_or_group
    several = [ALL, *(suite_sets(config_dir) if key == SUITE else ())]
    everything = key in LISTED and override.value() in several
    # What Hydra could do beyond setting keys is refused when composing, with or without several values.
    other = override.is_delete() or override.package is not None or override.is_hydra_override()
    if other or not (everything or override.is_sweep_override()):
        return _Axis(token, key, {"": token})
    head = key.partition(".")[0]
    if head in ONE_VALUE or head in ROOT:
        reason = ONE_VALUE.get(head, "it belongs to the run as a whole")
        hint = f"; {TEXT_WITH_COMMAS.format(key=key)}" if head in ROOT and ROOT[head].kind is str else ""
        raise ConfigError(f"{shown(token)}: {key} takes one value, since {reason}{hint}")
    tokens = {value: f"{override.get_key_element()}={value}" for value in _values(override, token, config_dir)}
    if not tokens:
        raise ConfigError(f"{shown(token)} stands for no value at all")
    return _Axis(token, key, tokens)


def _values(override: Any, token: str, config_dir: Path | None) -> Iterator[str]:  # noqa: ANN401 - Hydra's own class
    """Yield the values in the grammar of overrides, no more than are allowed and one."""
    from hydra.core.override_parser.types import Glob, Transformer
    from hydra.errors import HydraException

    key, value = override.key_or_group, override.value()
    known = list(choices(key, config_dir)) if key in LISTED else []
    sets = suite_sets(config_dir) if key == SUITE else ()
    if value == ALL:
        yield from known
    elif isinstance(value, str) and value in sets:
        yield from (member.suite for member in members(value, config_dir))
    elif isinstance(value, Glob):
        if not known:
            raise ConfigError(f"{shown(token)}: glob(...) chooses among the files of a group, and {key} is none")
        yield from value.filter(known)
    elif override.is_interval_sweep() or getattr(value, "shuffle", False):
        raise ConfigError(f"{shown(token)}: a table needs values in a fixed order; write them out, {key}=a,b,c")
    else:
        try:
            for item in islice(override.sweep_iterator(Transformer.identity), MOST + 1):
                if key not in LISTED:
                    yield _text(item, Transformer.str)
                elif (name := getattr(item, "text", item)) == ALL:
                    yield from known
                elif name in sets:
                    yield from (member.suite for member in members(name, config_dir))
                else:
                    check_choice(key, name, config_dir)
                    yield choice_named(name)
        except (HydraException, ValueError) as err:
            if may_be_secret(token):
                raise ConfigError(f"cannot read {shown(token)!r}") from None
            raise ConfigError(f"cannot read {token!r} ({err})") from err


def _text(item: object, write: Any) -> str:  # noqa: ANN401 - Hydra's own function, which is not typed
    """Write a value as it would be typed alone."""
    if isinstance(item, bool):
        return str(item).lower()
    if isinstance(item, str) and "${" in item:
        return item
    return str(write(item))
