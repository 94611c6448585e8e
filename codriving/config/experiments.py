"""The files of `codriving experiment`: rows and columns as lists of overrides, checked when they are read."""

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

from codriving.config.choices import EXPERIMENTS, TABLES, check_config_dir, choices, describe, read_yaml
from codriving.config.overrides import parse
from codriving.config.schema import NODES, ROOT, unknown
from codriving.errors import ConfigError

ROWS, ABLATION_TABLE, LEARNING_TABLE = "rows", "ablation", "learning"

# What a file can make of its rows. Some tables find their rows by themselves, others if none are named.
KINDS = (ROWS, ABLATION_TABLE, LEARNING_TABLE, *TABLES)
OWN_ROWS = (LEARNING_TABLE, "load", "orders", "filters", "models")

KEYS = ("table", "like", "set", "rows", "columns", "paper", "case")

WORDS = ("controls", "interactions", "epochs")  # What commands read beside the keys of a config

ALL_OF_PAPER = "paper"  # The word for every experiment of the paper; none may be called so

DELTA = "# @package"  # How a file begins that is a set of changes in Hydra's own form, and has no rows

_NAME = re.compile(r"[\w.+-][\w .,:;=/()%+-]{0,59}")
_STEM = re.compile(r"[A-Za-z0-9_][A-Za-z0-9._-]{0,59}")

Overrides = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ExperimentFile:
    """What a file says."""

    file: Path
    sentence: str
    table: str
    common: Overrides = ()  # ``set``: what holds for all cells unless the command line says otherwise
    rows: Mapping[str, Overrides] = field(default_factory=dict)
    columns: Mapping[str, Overrides] = field(default_factory=dict)
    shows: str = ""  # What of the paper it is of
    numbers: str = ""  # Name of the CSV beside it with the paper's numbers
    case: bool = False  # Whether one seed is shown in all rows

    @property
    def name(self) -> str:
        """What it is called."""
        return self.file.stem

    @property
    def words(self) -> list[str]:
        """What it says to the command beside the keys of a config."""
        return [token for token in self.common if key_of(token) in WORDS]

    def settings(self, given: Collection[str]) -> tuple[list[str], dict[str, Overrides]]:
        """Give what holds for all cells, and the columns, without what the command line sets.

        Columns that are then the same are one.

        Args:
            given: Keys that the command line sets.
        """
        common = [token for token in self.common if key_of(token) not in (*given, *WORDS)]
        if "experiment" not in {*given, *map(key_of, common)}:
            common.insert(0, f"experiment={self.name}")
        kept: dict[Overrides, str] = {}
        for name, tokens in (self.columns or {"": ()}).items():
            kept.setdefault(tuple(token for token in tokens if key_of(token) not in given), name)
        return common, {name: tokens for tokens, name in kept.items()}


def key_of(token: str) -> str:
    """Give the key of an override."""
    return token.lstrip("+").partition("=")[0]


def experiment_names(config_dir: Path | None = None) -> dict[str, Path]:
    """List the experiments with rows, by name."""
    return {name: file for name, file in choices(EXPERIMENTS, config_dir).items() if not is_delta(file)}


def is_delta(file: Path) -> bool:
    """Whether a file is a set of changes in Hydra's own form."""
    return read_yaml(file).lstrip().startswith(DELTA)


def experiment_file(name: str, config_dir: Path | None = None) -> ExperimentFile:
    """Read the experiment of a name, or that of a file.

    Raises:
        ConfigError: If there is none, or it cannot be used; with file, place and cure.
    """
    if config_dir is not None:
        check_config_dir(config_dir)
    known = experiment_names(config_dir)
    if name in known:
        return _read(known[name], config_dir, ())
    file = Path(name).expanduser()
    if name.endswith((".yaml", ".yml")) or "/" in name:
        if not file.is_file():
            raise ConfigError(f"there is no file {file}; name one, or one of: {', '.join(known)}")
        return _read(file, config_dir, ())
    if name in choices(EXPERIMENTS, config_dir):
        raise ConfigError(
            f"{name} is a set of changes and has no rows; write codriving run experiments={name}, or give it rows"
        )
    raise ConfigError(
        f"unknown experiment {name!r:.100}; write codriving experiment NAME|FILE [KEY=VALUE]..., experiments: "
        f"{', '.join(known)}"
    )


@cache
def built_in(name: str) -> ExperimentFile:
    """Read one of ours."""
    return experiment_file(name)


def changes_of(file: Path, config_dir: Path | None = None) -> list[str]:
    """Give what ``experiments=NAME`` stands for: what a file sets, without what is the matter of a command."""
    read, found = _read(file, config_dir, ()), []
    for token in (*read.common, *([] if _sets(read.common, "experiment") else [f"experiment={read.name}"])):
        if key_of(token) not in WORDS and not parse(token).is_sweep_override() and not token.endswith("=all"):
            found.append(token)
    return found


def _sets(tokens: Sequence[str], key: str) -> bool:
    return any(key_of(token) == key for token in tokens)


def _read(file: Path, config_dir: Path | None, before: Sequence[Path]) -> ExperimentFile:
    if not (sentence := describe(file)):
        raise ConfigError(f"{file} must begin with a sentence that says what it shows; write it after # on line 1")
    if file.stem == ALL_OF_PAPER:
        raise ConfigError(f"{file} is called {ALL_OF_PAPER}, which stands for all of the paper's; give it another name")
    if not _STEM.fullmatch(file.stem):
        raise ConfigError(f"{file} names a folder of runs; call it by letters, digits, dots, dashes and underscores")
    said = _loaded(file)
    if strange := [str(key) for key in said if key not in KEYS]:
        raise ConfigError(f"{file}: {unknown(strange[0], KEYS, 'an experiment')}")
    base = _base(file, said, config_dir, before)
    table = said.get("table", base.table if base else ROWS)
    if table not in KINDS:
        raise ConfigError(f"{file}: table must be one of {', '.join(KINDS)}, got {table!r:.100}")
    common = _tokens(said.get("set", []), f"{file}: set", several=True)
    if base:
        own = {key_of(token) for token in (*common, "experiment=")}
        common = (*(token for token in base.common if key_of(token) not in own), *common)
    rows = _named(said["rows"], f"{file}: rows") if "rows" in said else (base.rows if base else {})
    columns = _named(said["columns"], f"{file}: columns") if "columns" in said else (base.columns if base else {})
    if table in OWN_ROWS and "rows" in said:
        raise ConfigError(f"{file}: table: {table} finds its rows by itself; leave rows out")
    if table in (ROWS, ABLATION_TABLE) and not rows:
        raise ConfigError(f"{file}: rows is missing; write rows: and below it NAME: [KEY=VALUE, ...]")
    if table in TABLES and (strange := [n for n, t in rows.items() if [key_of(token) for token in t] != ["method"]]):
        raise ConfigError(
            f"{file}: rows.{strange[0]} must be [method=NAME], since table: {table} compares methods; table: {ROWS} "
            "takes any settings"
        )
    made = ExperimentFile(file, sentence, table, common, {} if table in OWN_ROWS else rows, columns)
    case = said.get("case", False)
    if not isinstance(case, bool):
        raise ConfigError(f"{file}: case must be true or false, got {case!r:.100}")
    return _with_paper(replace(made, case=case), said.get("paper", {}))


def _base(
    file: Path, said: Mapping[str, Any], config_dir: Path | None, before: Sequence[Path]
) -> ExperimentFile | None:
    """Read the file that another one is like."""
    if "like" not in said:
        return None
    known, name = experiment_names(config_dir), said["like"]
    if name not in known:
        raise ConfigError(f"{file}: like must name an experiment, got {name!r:.100}; experiments: {', '.join(known)}")
    if known[name].resolve() in [one.resolve() for one in (*before, file)]:
        raise ConfigError(f"{file}: like: {name} leads back to the file itself; write out its rows")
    return _read(known[name], config_dir, (*before, file))


def _with_paper(made: ExperimentFile, said: object) -> ExperimentFile:
    keys = ("shows", "numbers")
    if not isinstance(said, Mapping) or not all(isinstance(text, str) for text in said.values()):
        raise ConfigError(f"{made.file}: paper must hold {' and '.join(keys)}, two texts, got {said!r:.100}")
    if strange := [str(key) for key in said if key not in keys]:
        raise ConfigError(f"{made.file}: paper: {unknown(strange[0], keys, 'paper')}")
    numbers = said.get("numbers", "")
    if numbers and not (made.file.parent / numbers).is_file():
        raise ConfigError(f"{made.file}: paper.numbers must be the name of a CSV beside it, and {numbers} is not there")
    return replace(made, shows=said.get("shows", ""), numbers=numbers)


def _loaded(file: Path) -> dict[str, Any]:
    from yaml import YAMLError

    try:
        found = _load(read_yaml(file))
    except _TwiceError as err:
        raise ConfigError(f"{file}: {err}") from None
    except (YAMLError, RecursionError, ValueError) as err:
        why = " ".join(str(err).split())
        raise ConfigError(f"{file} cannot be read ({why:.300}); mend the YAML there") from err
    if not isinstance(found, dict):
        raise ConfigError(f"{file} must hold rows: and below it NAME: [KEY=VALUE, ...]; docs/experiments.md shows one")
    return found


class _TwiceError(Exception):
    """Raised when a name stands twice, of which plain YAML would take the last."""


def _load(text: str) -> object:
    from yaml import MappingNode, SafeLoader, load

    class Loader(SafeLoader):
        """Says where a name stands twice."""

        def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:  # noqa: ANN401 - a node of PyYAML
            seen: dict[str, int] = {}
            for key, _ in node.value if isinstance(node, MappingNode) else ():
                line = key.start_mark.line + 1
                if str(key.value) in seen:
                    raise _TwiceError(
                        f"{str(key.value)!r:.100} stands twice, on lines {seen[str(key.value)]} and {line}; give each "
                        "row, column or key a name of its own"
                    )
                seen[str(key.value)] = line
            return super().construct_mapping(node, deep)

    return load(text, Loader)


def _named(node: object, where: str) -> dict[str, Overrides]:
    if not isinstance(node, Mapping) or not node:
        raise ConfigError(f"{where} must name at least one, got {node!r:.100}; write below it NAME: [KEY=VALUE, ...]")
    found: dict[str, Overrides] = {}
    for name, tokens in node.items():
        if not isinstance(name, str) or not _NAME.fullmatch(name):
            raise ConfigError(
                f"{where}: {name!r:.100} is no name; take a text of at most 60 letters, digits and plain signs, and "
                "quote numbers, true and false"
            )
        found[name] = _tokens(tokens, f"{where}.{name}")
    for name, tokens in found.items():
        alike = next(other for other, theirs in found.items() if sorted(theirs) == sorted(tokens))
        if alike != name:
            raise ConfigError(f"{where}.{name} sets the same as {alike}; leave one of them out")
    return found


def _tokens(node: object, where: str, several: bool = False) -> Overrides:
    if not isinstance(node, list) or not all(isinstance(token, str) for token in node):
        raise ConfigError(f"{where} must be a list of key=value, got {node!r:.100}; write [scenario=merge] or []")
    for token in node:
        if key_of(token) in WORDS:
            if not several:
                raise ConfigError(f"{where}: {key_of(token)} holds for all of it; write it below set")
            continue
        try:
            override = parse(token)
        except ConfigError as err:
            raise ConfigError(f"{where}: {err}") from err
        key = override.key_or_group
        if (head := key.partition(".")[0]) not in (*ROOT, *NODES, "suite"):
            raise ConfigError(f"{where}: {unknown(head, (*ROOT, *NODES, 'suite'), 'the config')}")
        if not several and (override.is_sweep_override() or override.value() == "all"):
            raise ConfigError(f"{where}: {key} takes one value here; give each value a row or column of its own")
        if not several and head in ROOT and head not in ("plugins", "prompts"):
            raise ConfigError(f"{where}: {key} belongs to the run as a whole; write it below set")
    return tuple(node)
