"""The axes of `codriving stress`: one YAML in conf/stress each, and those of the user, checked when they are read."""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from codriving.config.choices import EXPERIMENTS, STRESS, SUITE, check_config_dir, choices, describe
from codriving.config.compose import one_line
from codriving.config.overrides import parse
from codriving.config.references import check_references
from codriving.config.schema import NODES, ROOT, unknown
from codriving.datatypes import StressAxis, StressLevel
from codriving.errors import ConfigError

KEYS, LEVEL_KEYS = ("name", "unit", "levels"), ("value", "set")

# What is the same for all points of a curve, or varies between curves.
FIXED = (*ROOT, "method", "cda", "metrics", "launcher", "flow", SUITE, EXPERIMENTS)


def stress_axis(name: str, config_dir: Path | None = None) -> StressAxis:
    """Read an axis.

    Raises:
        ConfigError: If there is none of that name, or its file cannot be used; with file, key and cure.
    """
    if config_dir is not None:
        check_config_dir(config_dir)
    known = choices(STRESS, config_dir)
    if name not in known:
        raise ConfigError(
            f"unknown axis {name!r:.100}; write codriving stress AXIS [KEY=VALUE]..., axes: {', '.join(known)}"
        )
    file = known[name]
    read = _read(file)
    for key in ("name", "unit"):
        if not isinstance(read[key], str) or (key == "name" and not read[key].strip()):
            raise ConfigError(f'{file}: {key} must be a text, got {read[key]!r:.100}; write for instance {key}: "%"')
    levels = read["levels"]
    if not isinstance(levels, list) or len(levels) < 2:
        raise ConfigError(f"{file}: levels must be a list of two or more, the mildest first, got {levels!r:.100}")
    made = tuple(_level(level, f"{file}: levels.{index}") for index, level in enumerate(levels))
    _check_values([level.value for level in made], file)
    for index, level in enumerate(made):
        if level.overrides in (earlier := [other.overrides for other in made[:index]]):
            raise ConfigError(
                f"{file}: levels.{index}.set is the same as levels.{earlier.index(level.overrides)}.set; "
                "give each level other values"
            )
    return StressAxis(name, read["name"], read["unit"], _sentence(file), made)


def _read(file: Path) -> dict[str, Any]:
    from omegaconf import OmegaConf
    from yaml import YAMLError

    _sentence(file)
    try:
        found = OmegaConf.to_container(OmegaConf.load(file), resolve=False)
    except (YAMLError, OSError) as err:
        raise ConfigError(f"{file} cannot be read ({one_line(err)}); mend the YAML there") from err
    if not isinstance(found, dict):
        raise ConfigError(f"{file} must hold the keys {', '.join(KEYS)}; docs/stress.md shows an axis")
    check_references(found, file)
    _check_keys(found, KEYS, "an axis", str(file))
    return {str(key): value for key, value in found.items()}


def _sentence(file: Path) -> str:
    if not (said := describe(file)):
        raise ConfigError(f"{file} must begin with a sentence that says what is varied; write it after # on line 1")
    return said


def _check_keys(node: Mapping[Any, Any], keys: Sequence[str], what: str, where: str) -> None:
    if strange := [str(key) for key in node if key not in keys]:
        raise ConfigError(f"{where}: {unknown(strange[0], keys, what)}")
    if missing := [key for key in keys if key not in node]:
        raise ConfigError(f"{where}: {missing[0]} is missing; {what} has the keys {', '.join(keys)}")


def _level(node: object, where: str) -> StressLevel:
    if not isinstance(node, Mapping):
        raise ConfigError(
            f"{where} must hold value and set, got {node!r:.100}; write - value: 1 and below it set: [...]"
        )
    _check_keys(node, LEVEL_KEYS, "a level", where)
    value, tokens = node["value"], node["set"]
    plain = (isinstance(value, str) and value.strip()) or (isinstance(value, int | float) and math.isfinite(value))
    if not plain or isinstance(value, bool):
        raise ConfigError(f"{where}.value must be a number or a name, got {value!r:.100}; quote a name")
    if not isinstance(tokens, list) or not all(isinstance(token, str) for token in tokens):
        raise ConfigError(f"{where}.set must be a list of key=value, got {tokens!r:.100}; write set: [scenario.cavs=6]")
    for token in tokens:
        try:
            override = parse(token)
        except ConfigError as err:
            raise ConfigError(f"{where}.set: {err}") from err
        key = override.key_or_group
        if override.is_sweep_override():
            raise ConfigError(f"{where}.set: {key} takes one value at a level; give each value a level of its own")
        head = key.partition(".")[0]
        if head in FIXED:
            raise ConfigError(f"{where}.set: {key} is no axis, since curves or runs differ in it; leave it out")
        if head not in NODES:
            raise ConfigError(f"{where}.set: {unknown(head, NODES, 'the config')}")
    return StressLevel(value if isinstance(value, str) else float(value), tuple(tokens))


def _check_values(values: Sequence[float | str], file: Path) -> None:
    numbers = [value for value in values if isinstance(value, float)]
    if len(numbers) not in (0, len(values)):
        raise ConfigError(f"{file}: levels have numbers and names as values; give all of them one kind")
    if not numbers and len(set(values)) < len(values):
        raise ConfigError(f"{file}: levels have the same value twice; give each level a name of its own")
    if numbers and not (all(a < b for a, b in pairwise(numbers)) or all(a > b for a, b in pairwise(numbers))):
        shown = ", ".join(f"{number:g}" for number in numbers)
        raise ConfigError(f"{file}: values of levels must rise, or fall, from level to level, got {shown}; order them")
