"""What the shell offers after TAB: groups, their choices, and the keys with the values they have."""

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import typer

from codriving.config import (
    ALL,
    EXPERIMENTS,
    GROUPS,
    LISTED,
    PLUGINS,
    ROOT,
    STRESS,
    SUITE,
    SWEPT,
    TABLES,
    TRAININGS,
    choices,
    conf_dir,
    default_choice,
    describe,
    experiment_names,
    suite_sets,
    values,
)
from codriving.errors import ConfigError

# How `codriving list` calls the groups.
PLURALS = {
    "scenarios": "scenario",
    "methods": "method",
    "executors": "executor",
    "orders": "order",
    "filters": "filter",
    "cdas": "cda",
    "llms": "llm",
    "memories": "memory",
    "metrics": "metrics",
    "launchers": "launcher",
    "limits": "limits",
    "drivers": "drivers",
    "flows": "flow",
    "channels": "v2x",
    "judgements": "judgement",
    "suites": SUITE,
    "experiments": EXPERIMENTS,
    "trainings": TRAININGS,
    "axes": STRESS,
}


def complete_group(incomplete: str) -> list[str]:
    """Offer the groups of `codriving list`."""
    return [plural for plural in PLURALS if plural.startswith(incomplete)]


def complete_format(incomplete: str) -> list[str]:
    """Offer the formats of `codriving replay`."""
    return [name for name in ("mp4", "gif") if name.startswith(incomplete)]


def complete_layout(incomplete: str) -> list[str]:
    """Offer the layouts of `codriving export`."""
    return [name for name in ("fcd", "interhub", "csv", "sft") if name.startswith(incomplete)]


def complete_table(incomplete: str) -> list[tuple[str, str]]:
    """Offer the tables of `codriving compare`."""
    return [(name, meaning) for name, meaning in TABLES.items() if name.startswith(incomplete)]


def complete_experiment(ctx: typer.Context, incomplete: str) -> list[tuple[str, str]]:
    """Offer the experiments with rows."""
    folder = ctx.params.get("config_dir")
    found = experiment_names(folder.expanduser() if folder else None)
    return [(name, describe(file)) for name, file in found.items() if name.startswith(incomplete)]


def complete_axis(ctx: typer.Context, incomplete: str) -> list[tuple[str, str]]:
    """Offer the axes of `codriving stress`, after a comma those that have not been named yet."""
    before, comma, _ = incomplete.rpartition(",")
    named = before.split(",")
    files = TypedLine(ctx.params.get("config_dir")).choices(STRESS)
    found = [(f"{before}{comma}{name}", describe(file)) for name, file in files.items() if name not in named]
    everything = [] if comma else [(ALL, "Every one of these, a table each.")]
    return [(word, text) for word, text in [*found, *everything] if word.startswith(incomplete)]


def complete_in_line(ctx: typer.Context, incomplete: str) -> list[tuple[str, str]]:
    """Offer overrides that begin with what has been typed, by what stands before it in the line."""
    # Bash splits words at ``=``, also those before the cursor.
    line = " ".join(ctx.params.get("overrides") or ()).replace(" = ", "=")
    return complete_override(incomplete, TypedLine(ctx.params.get("config_dir"), tuple(line.split())))


@dataclass(frozen=True, slots=True)
class TypedLine:
    """What has been typed before the word under the cursor."""

    config_dir: Path | None = None
    overrides: tuple[str, ...] = ()  # ``key=value`` tokens

    def choices(self, group: str) -> dict[str, Path]:
        """Return what a group offers."""
        return choices(group, self.config_dir.expanduser() if self.config_dir else None)

    def suite_sets(self) -> list[str]:
        """Return the names of the sets of suites."""
        return list(suite_sets(self.config_dir.expanduser() if self.config_dir else None))

    def chosen(self, group: str) -> str | None:
        """Return what a group is set to; of several values the first."""
        typed = [token.partition("=")[2] for token in self.overrides if token.partition("=")[0] == group]
        if typed or group == SUITE:
            return typed[-1].split(",")[0] if typed else default_choice(group)
        return default_choice(group, self.choices(SUITE).get(self.chosen(SUITE) or ""))


def complete_override(incomplete: str, line: TypedLine = TypedLine()) -> list[tuple[str, str]]:
    """Offer overrides that begin with what has been typed."""
    before, typed = _whole_word(incomplete)
    try:
        return [(word[len(before) :], text) for word, text in _offers(typed, line) if word.startswith(typed)]
    except (ConfigError, OSError):
        return []


def _whole_word(incomplete: str) -> tuple[str, str]:
    """Return what stands before the word in the shell's eyes, and the whole override as typed."""
    words = os.environ.get("COMP_WORDS", "").split("\n")
    cursor = os.environ.get("COMP_CWORD", "")
    if not cursor.isdecimal() or int(cursor) >= len(words) + 1:
        return "", incomplete
    position = int(cursor)
    here = words[position] if position < len(words) else ""
    if here == "=" and position >= 1:
        before = f"{words[position - 1]}="
        return before, before
    if position >= 2 and words[position - 1] == "=":
        before = f"{words[position - 2]}="
        return before, before + here
    return "", incomplete


def _offers(typed: str, line: TypedLine) -> Iterator[tuple[str, str]]:
    left, _, value = typed.partition("=")
    head = left.partition(".")[0]
    if "," in value and "[" not in value:
        yield from _further(left, value, line)
        return
    if "." in left and head in GROUPS:
        yield from _keys(head, line)
        return
    for group in LISTED:
        for name, file in line.choices(group).items():
            yield f"{group}={name}", describe(file)
        if group == SUITE:
            yield from (
                (f"{group}={name}", "A set of suites: one row of the table each.") for name in line.suite_sets()
            )
        if group in SWEPT and len(line.choices(group)) > 1:
            yield f"{group}={ALL}", "Every one of these: one row of the table each."
    defaults = values(conf_dir() / "config.yaml")
    for name, key in ROOT.items():
        yield f"{name}={defaults.get(name, '')}", key.meaning


def _further(key: str, value: str, line: TypedLine) -> Iterator[tuple[str, str]]:
    """Offer, after a comma, the choices that have not been named yet."""
    before, _, _ = value.rpartition(",")
    named = before.split(",")
    if key in SWEPT:
        yield from ((f"{key}={before},{n}", describe(file)) for n, file in line.choices(key).items() if n not in named)
    elif "." in key and key.partition(".")[0] in SWEPT:
        for word, text in _keys(key.partition(".")[0], line):
            option = word.removeprefix(f"{key}=")
            if option != word and option not in named:
                yield f"{key}={before},{option}", text


def _keys(group: str, line: TypedLine) -> Iterator[tuple[str, str]]:
    """Offer the keys of what a group is set to, with the values they have."""
    chosen, files = line.chosen(group), line.choices(group)
    if chosen in files:
        for name, value in values(files[chosen]).items():
            if name in (PLUGINS, group):  # The group itself, where a choice is nothing
                continue
            for option in ("true", "false") if value in ("true", "false") else (value.replace(" ", ""),):
                yield f"{group}.{name}={option}", ""
