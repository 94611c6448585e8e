"""Methods on the same seeds: which cells a comparison has, and which of them differ in the method alone."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from codriving.config.choices import TABLES, TAKING_PART, choices
from codriving.config.overrides import check_choice, parse
from codriving.config.show import fingerprint
from codriving.config.sweep import Point, expand
from codriving.errors import ConfigError

BASELINES, SINGLE_VEHICLE, ALL, LOAD = "baselines", "single-vehicle", "all", "load"

EXPERIMENT = {BASELINES: "compare", SINGLE_VEHICLE: "compare-single-vehicle", ALL: "compare-all", LOAD: "load"}
"""The folder of each table's runs, if the user names none."""

CAVS = "scenario.cavs"
"""The key that the load is."""

LOADED = ("scenario=intersection,roundabout", f"{CAVS}=4,6,8,12")
"""What `codriving compare load` drives, as far as the user does not set it."""


def comparison(table: str | None, overrides: Sequence[str], config_dir: Path | None = None) -> list[Point]:
    """Find out what a comparison consists of.

    Every method of the table that has a YAML takes part. ``method=`` adds others to them.

    Args:
        overrides: ``key=value`` tokens that hold for every cell; with several values, for one block of rows each.

    Raises:
        ConfigError: If there is no such table, or an override cannot be read.
    """
    if table is None or table not in TABLES:
        given = "compare needs the name of a table" if table is None else f"unknown table {table!r}"
        raise ConfigError(f"{given}; write codriving compare TABLE [KEY=VALUE]..., tables: {', '.join(TABLES)}")
    keys = [parse(token).key_or_group for token in overrides]
    added = [token for token, key in zip(overrides, keys, strict=True) if key == "method"]
    others = [token for token, key in zip(overrides, keys, strict=True) if key != "method"]
    if table == LOAD:
        others = [*(token for token in LOADED if token.partition("=")[0] not in keys), *others]
    # Asked for once more on the command line, it is the user's.
    base = () if "experiment" in keys else (f"experiment={EXPERIMENT[table]}",)
    methods = _methods(table, added, config_dir)
    return [
        Point((*base, *point.overrides, f"method={name}"), {**point.swept, "method": name}, point.removed)
        for point in expand(others, config_dir)
        for name in methods
    ]


def _methods(table: str, added: Sequence[str], config_dir: Path | None) -> list[str]:
    """The methods that take part: those of the table that exist, then what the user adds."""
    own = [point.overrides[0].partition("=")[2] for token in added for point in expand([token], config_dir)]
    known = choices("method", config_dir)
    for name in own:
        check_choice("method", name, config_dir)
    return list(dict.fromkeys([*(name for name in TAKING_PART[table] if name in known), *own]))


def setting(resolved: Mapping[str, Any]) -> str:
    """Mark the setting of a cell: cells with the same mark differ in the method alone."""
    return fingerprint({key: value for key, value in resolved.items() if key not in ("method", "plugins")})
