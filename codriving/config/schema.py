"""The root of the config as a table: which keys there are, what they mean and which values they take."""

import difflib
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from codriving.errors import ConfigError

# A key in the query of an address or in a mapping, user and password in an address, and keys of well-known providers.
_LOOKS_SECRET = re.compile(
    r"(key|token|secret|password|credential)s?[\"']?\s*[=:]|://[^/\s]*@|\b(sk|gsk|hf|ghp|AIza|xai)[-_]?\w{12,}",
    re.IGNORECASE,
)


def looks_secret(text: str) -> bool:
    """Tell whether a value may be a secret by its look."""
    return _LOOKS_SECRET.search(text) is not None


def value_shown(value: object) -> str:
    """Give a value for a message, if it does not look like a secret."""
    text = repr(value)
    return "a value that is not shown" if looks_secret(text) else text if len(text) <= 200 else f"{text[:200]}..."


# The choices that the command line names; one YAML a choice.
GROUPS = (
    *("scenario", "method", "executor", "order", "filter", "cda", "llm", "memory", "metrics", "launcher", "limits"),
    *("drivers", "flow", "v2x", "judgement"),
)

NODES = (*GROUPS, "thinking", "environment")  # The keys of the root that hold a constructor call

SHOWN = ("_tables_", "_style_")  # What a method's YAML says for tables and figures; it is no part of a run

OPTIONAL = ("order", "filter", "memory", "limits", "flow", "v2x", "judgement")  # Those of them that may be null

LARGEST_SEED = 2**31 - 1  # Seeds beyond this are refused by some of the generators below us


@dataclass(frozen=True, slots=True)
class Key:
    """One plain key of the root."""

    name: str
    meaning: str
    kind: type
    low: int = 0
    high: int = 0
    words: tuple[str, ...] = ()  # Words that are allowed instead of the type, for instance ``auto``
    pattern: str | None = None
    form: str = "a name of letters, digits, dots, dashes and underscores"  # What the pattern asks for
    optional: bool = False  # Whether ``null`` is allowed

    @property
    def rule(self) -> str:
        """The rule in words, as it stands in messages and in the docs."""
        rule = {
            bool: "true or false",
            int: f"a whole number, {self.low} to {self.high}",
            list: "a list of package names, for instance [my_package]",
            str: self.form if self.pattern else "a text",
        }[self.kind]
        return " or ".join([rule, *self.words, *(["null"] if self.optional else [])])

    def allows(self, value: object) -> bool:
        """Tell whether a value follows the rule."""
        if value is None or value in self.words:
            return value is not None or self.optional
        if self.kind is list:
            return isinstance(value, list) and all(isinstance(v, str) and _PACKAGE.fullmatch(v) for v in value)
        if not isinstance(value, self.kind) or isinstance(value, bool) != (self.kind is bool):
            return False
        if self.kind is int:
            return self.low <= value <= self.high  # type: ignore[operator]
        return self.kind is bool or re.fullmatch(self.pattern or r"(?s).+", str(value)) is not None


_NAME = r"[A-Za-z0-9_-][A-Za-z0-9._-]*"
_PACKAGE = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")

KEYS = (
    Key("episodes", "number of episodes a cell", int, 1, 100_000),
    Key("seed", "seed of the first episode; the others follow it one by one", int, 0, LARGEST_SEED),
    Key("workers", "episodes driven at once; auto: one a core, or llm.max_concurrency", int, 1, 256, words=("auto",)),
    Key("run", "name of the run folder; the same name resumes; null takes the time", str, pattern=_NAME, optional=True),
    Key("output", "folder under which the run folders are written", str),
    Key("experiment", "folder below output, one an experiment", str, pattern=_NAME),
    Key("render", "whether each episode leaves a film, replay.mp4 beside its record", bool),
    Key(
        "shard",
        "which share of a run is driven, into a part of its own; null drives all",
        str,
        words=("slurm",),
        pattern=r"[1-9][0-9]{0,3}/[1-9][0-9]{0,3}",
        form="i/n with i from 1 to n, for instance 1/4,",
        optional=True,
    ),
    Key("prompts", "set of prompts, or folder with templates that replace them; null takes ours", str, optional=True),
    Key("plugins", "packages of yours whose classes a config may name", list),
)

ROOT = {key.name: key for key in KEYS}


def unknown(key: str, known: Iterable[str], where: str, others: Iterable[str] = ()) -> ConfigError:
    """Make the error for a key that is not read."""
    names = sorted(known)
    node, dot, last = key.rpartition(".")
    close = difflib.get_close_matches(last, names, n=1)
    hint = f"did you mean {node}{dot}{close[0]}? " if close else ""
    if choices := " or ".join(f"{node}={name}" for name in others):
        hint = f"it is a key of {choices}; "
    return ConfigError(f"unknown key {key}; {hint}keys of {where}: {', '.join(names) or 'none'}")


def texts(node: object, key: str = "") -> Iterator[tuple[str, str]]:
    """Yield every text with its dotted key."""
    if isinstance(node, Mapping):
        for name, value in node.items():
            yield from texts(value, f"{key}.{name}" if key else str(name))
    elif isinstance(node, list):
        for index, value in enumerate(node):
            yield from texts(value, f"{key}.{index}")
    elif isinstance(node, str):
        yield key, node


def check_root(resolved: Mapping[str, Any]) -> None:
    """Check the keys, types and ranges of the root."""
    known = (*ROOT, *NODES)
    if strange := [str(name) for name in resolved if name not in known]:
        raise unknown(strange[0], known, "the config")
    if missing := [name for name in known if name not in resolved]:
        raise ConfigError(f"{missing[0]} is missing from the config")
    for name, key in ROOT.items():
        if not key.allows(resolved[name]):
            raise ConfigError(f"{name} must be {key.rule}, got {value_shown(resolved[name])}")
    if alien := [name for name in resolved["plugins"] if name.partition(".")[0] in sys.stdlib_module_names]:
        raise ConfigError(
            f"plugins must name packages of yours, and {alien[0]} is one of Python's standard library; give it another "
            "name if it is yours, and leave it out otherwise"
        )
    for name in NODES:
        node = resolved[name]
        if isinstance(node, Mapping) and "_target_" not in node:
            cure = f"; choose one with {name}=<name> first" if name in OPTIONAL else ""
            raise ConfigError(
                f"{name} has no _target_, so no class would read {', '.join(map(str, node)) or 'it'}{cure}"
            )
        if not (isinstance(node, Mapping) or (node is None and name in OPTIONAL)):
            raise ConfigError(f"{name} must name one of its YAML files or hold a _target_, got {value_shown(node)}")
