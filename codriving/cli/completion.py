"""What the shell offers after TAB: groups, their choices, and the keys with the values they have."""

import os
from collections.abc import Iterator

from codriving.config.choices import EXPERIMENTS, LISTED, choices, default_choice, describe, values
from codriving.config.locate import conf_dir
from codriving.config.schema import GROUPS, ROOT
from codriving.errors import ConfigError

PLURALS = {
    "scenarios": "scenario",
    "methods": "method",
    "cdas": "cda",
    "llms": "llm",
    "memories": "memory",
    "metrics": "metrics",
    "launchers": "launcher",
    "experiments": EXPERIMENTS,
}
"""How `codriving list` calls the groups."""


def complete_group(incomplete: str) -> list[str]:
    """Offer the groups of `codriving list`.

    Args:
        incomplete: What has been typed.
    """
    return [plural for plural in PLURALS if plural.startswith(incomplete)]


def complete_override(incomplete: str) -> list[tuple[str, str]]:
    """Offer overrides that begin with what has been typed.

    Args:
        incomplete: The word under the cursor, as the shell hands it over.

    Returns:
        Pairs of the word to insert and a sentence on it.
    """
    before, typed = _whole_word(incomplete)
    try:
        return [(word[len(before) :], text) for word, text in _offers(typed) if word.startswith(typed)]
    except (ConfigError, OSError):
        return []


def _whole_word(incomplete: str) -> tuple[str, str]:
    """Return what stands before the word in the shell's eyes, and the whole override as typed.

    Bash splits words at ``=``: of ``scenario=int`` it hands over ``int`` and replaces no more than that.
    """
    words = os.environ.get("COMP_WORDS", "").split("\n")
    cursor = os.environ.get("COMP_CWORD", "")
    if not cursor.isdigit() or int(cursor) >= len(words) + 1:
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


def _offers(typed: str) -> Iterator[tuple[str, str]]:
    head = typed.partition("=")[0].partition(".")[0]
    if "." in typed.partition("=")[0] and head in GROUPS:
        yield from _keys(head)
        return
    for group in LISTED:
        for name, file in choices(group).items():
            yield f"{group}={name}", describe(file)
    defaults = values(conf_dir() / "config.yaml")
    for name, key in ROOT.items():
        yield f"{name}={defaults.get(name, '')}", key.meaning


def _keys(group: str) -> Iterator[tuple[str, str]]:
    """Offer the keys of what a group is set to by default, with the values they have."""
    chosen = default_choice(group)
    files = choices(group)
    if chosen in files:
        for name, value in values(files[chosen]).items():
            for option in ("true", "false") if value in ("true", "false") else (value.replace(" ", ""),):
                yield f"{group}.{name}={option}", ""
