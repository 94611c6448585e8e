"""Sets of suites: a CSV beside the YAMLs of suites names its members, and says when the world of each was fixed."""

import csv
import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codriving.config.build import TARGET
from codriving.config.choices import SUITE, choices, chosen_in
from codriving.config.locate import conf_dir
from codriving.errors import ConfigError

COLUMNS = ("suite", "fixed", "sha256")


@dataclass(frozen=True, slots=True)
class Member:
    """A suite of a set."""

    suite: str
    fixed: str  # The date on which its world was fixed
    sha256: str  # Of that world, as ``world_hash`` gives it


def suite_sets(config_dir: Path | None = None) -> dict[str, Path]:
    """List the sets of suites: the CSV file of each, by name."""
    roots = [conf_dir(), *([config_dir] if config_dir else [])]
    return {file.stem: file for root in roots for file in sorted((root / SUITE).glob("[!_]*.csv"))}


def members(name: str, config_dir: Path | None = None) -> tuple[Member, ...]:
    """Return the members of a set, in its order.

    Raises:
        ConfigError: If the file has other columns, or names a suite that there is not.
    """
    file, known = suite_sets(config_dir)[name], choices(SUITE, config_dir)
    try:
        rows = list(csv.DictReader(file.read_text(encoding="utf-8-sig").splitlines()))
    except (OSError, UnicodeDecodeError, csv.Error) as err:
        raise ConfigError(f"{file} cannot be read as CSV ({err})") from err
    if not rows or any(set(row) != set(COLUMNS) or None in row.values() for row in rows):
        raise ConfigError(f"{file} must have the columns {', '.join(COLUMNS)}, and a row for each suite of the set")
    if strange := [row["suite"] for row in rows if row["suite"] not in known]:
        raise ConfigError(f"{file} names the suite {strange[0]!r}, which there is not; choices: {', '.join(known)}")
    return tuple(Member(*(row[column] for column in COLUMNS)) for row in rows)


def world_hash(resolved: Mapping[str, Any]) -> str:
    """Return the SHA-256 of the world of a config: its environment with scenario, limits, drivers and flow.

    A channel and the time that thinking takes are a part of it where there are any; other worlds keep their hash.
    """
    world = dict(resolved["environment"])
    if resolved["v2x"] is not None:
        world["v2x"] = resolved["v2x"]
    times = {key: time for key, time in resolved["thinking"].items() if key not in (TARGET, "cda")}
    if any(times.values()):
        world["thinking"] = times
    text = json.dumps(world, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def changed_worlds(
    suites: Sequence[str | None], configs: Sequence[Mapping[str, Any]], config_dir: Path | None
) -> list[str]:
    """Say of every suite of a set whose world is not the one that was fixed that it is another one.

    Args:
        suites: The suite of each config; None where none was named.
    """
    fixed = [(name, member) for name in suite_sets(config_dir) for member in members(name, config_dir)]
    changed: dict[tuple[str, Member], dict[str, None]] = {}
    for suite, config in zip(suites, configs, strict=True):
        for name, member in fixed:
            if member.suite == suite and (found := world_hash(config)) != member.sha256:
                changed.setdefault((name, member), {})[found] = None
    return [
        f"suite={member.suite} is not the world that was fixed for suite={name} on {member.fixed}: its settings "
        f"were changed, so its numbers do not stand beside those of others (SHA-256 {found[0]}"
        f"{f' and {len(found) - 1} others' if len(found) > 1 else ''})."
        for (name, member), found in ((key, list(hashes)) for key, hashes in changed.items())
    ]


def sets_scenario(tokens: Sequence[str], config_dir: Path | None = None) -> bool:
    """Whether some overrides name a suite that chooses a scenario."""
    given = [token.partition("=")[2] for token in tokens if token.lstrip("+").partition("=")[0] == SUITE]
    sets, files = suite_sets(config_dir), choices(SUITE, config_dir)
    names = [name for text in given for name in text.split(",")]
    names += [member.suite for name in names if name in sets for member in members(name, config_dir)]
    return any(chosen_in(files[name], "scenario") for name in names if name in files)


def check_scenario(chosen: Mapping[str, Any], config_dir: Path | None = None) -> None:
    """Refuse a scenario beside a suite that is about another one.

    Raises:
        ConfigError: If the suite chooses a scenario, and another one is chosen.
    """
    suite, scenario = str(chosen.get(SUITE)), str(chosen.get("scenario"))
    file = choices(SUITE, config_dir).get(suite)
    own = chosen_in(file, "scenario") if file else None
    if own is not None and own != scenario:
        raise ConfigError(f"suite={suite} is about scenario={own}; leave scenario={scenario} out, or the suite")
