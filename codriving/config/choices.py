"""What can be chosen: the YAML files of each group, read without Hydra so that completion is quick."""

import re
from functools import cache
from pathlib import Path

from codriving.config.locate import conf_dir, experiments_root
from codriving.config.schema import GROUPS
from codriving.errors import ConfigError

EXPERIMENTS = "experiments"  # The group of deltas that reproduce one table or figure each

SUITE = "suite"  # The group of worlds: choices of other groups, and values; its name is no part of a run

LISTED = (*GROUPS, SUITE, EXPERIMENTS)  # Every group that has choices

TRAININGS = "train"  # The folder of the configs of trainings; no group of a run, which has no training

STRESS = "stress"  # The folder of the axes of `codriving stress`; no group either

# Groups of which one command can take every choice; a snapshot has to be named, so not every memory can be taken; and
# flows and episodes are not mixed.
SWEPT = tuple(group for group in GROUPS if group not in ("launcher", "memory", "flow"))

ALL = "all"  # The word for every choice of a group; no YAML may be called so

# What `codriving compare` makes.
TABLES = {
    "baselines": "The methods of the paper's comparison, each against codriving.",
    "single-vehicle": "The methods for a single vehicle, each against codriving.",
    "all": "The methods of both tables, each against codriving.",
    "methods": "The methods that method= names, each against codriving.",
    "load": "The methods of the first table with 4, 6, 8 and 12 CAVs.",
    "orders": "The paper's method with each passing order, each against the order that is negotiated.",
    "filters": "The methods of both tables, each with and without the safety check of codriving.",
    "models": "One method with each model that llm= names, and with controls and the rules in its place.",
}

CONTROLS, ABLATION = "controls", "ablation"  # The tables below others in which controls say their place

# Choices that come before the others: in the paper's order, or from the least to the most; the rest goes by name.
# Methods say their place themselves, and their rules come in the same order.
FIRST = {
    "scenario": ("intersection", "roundabout", "highway", "merge"),
    "order": ("negotiated",),
    "filter": ("false", "true"),
    "cda": ("status_sharing", "intent_sharing", "full", "agreement_seeking", "prescriptive"),
    "llm": ("offline", "first", "random"),
    "limits": ("none", "road"),
    "drivers": ("simulator", "attentive", "mixed", "rough", "site"),
    "flow": ("none", "steady"),
    "v2x": ("perfect", "good", "urban", "poor"),
    "judgement": ("road_rules", "rules_noted", "earliest", "learned", "remembered", "llm", "never", "always"),
    SUITE: ("default", "paper", "honest", "standoff", "crowd", "blind", "blocked_exit", "busy_merge"),
    "memory": ("off", "frozen", "online"),
    "metrics": ("standard",),
    STRESS: (
        *("age", "loss", "range", "noise", "thinking", "humans", "cavs"),
        *("not_yielding", "false_intents", "false_positions", "ghosts", "silent"),
    ),
}

_LINE = re.compile(r"^(\w+):[^\S\n]*([^#\n]*)", re.MULTILINE)
_STYLE = re.compile(r'^_style_: "(\S+) (\S+) (\S+)"', re.MULTILINE)
_TARGET = re.compile(r"^_target_: (\S+)", re.MULTILINE)
_PARENT = re.compile(r"\[(_\w+), _self_\]")
_DEFAULT = re.compile(r"^\s*-\s*(?:override /)?(\w+):\s*\"?(\w+)", re.MULTILINE)


def choices(group: str, config_dir: Path | None = None) -> dict[str, Path]:
    """List what a group offers.

    Args:
        group: Name of the group, for instance ``scenario``.

    Returns:
        The YAML file of each choice, by name, in the order in which tables and lists show them.

    Raises:
        ConfigError: If there is no such group.
    """
    if group not in (known := (*LISTED, TRAININGS, STRESS)):
        raise ConfigError(f"unknown group {group}; groups: {', '.join(known)}")
    roots = [experiments_root() if group == EXPERIMENTS else conf_dir(), *([config_dir] if config_dir else [])]
    found = {file.stem: file for root in roots for file in sorted((root / group).glob("[!_]*.yaml"))}
    first = (*FIRST.get(group, ()), *(taking_part("all") if group in ("method", "order") else ()))
    last = taking_part(CONTROLS) if group == "method" else ()
    rest = (name for name in sorted(found) if name not in last)
    return {name: found[name] for name in (*first, *rest, *last) if name in found}


@cache
def taking_part(table: str) -> tuple[str, ...]:
    """Return the methods of a table of ``compare``, or of ``stress``, in its order: each says its place in its YAML."""
    if table == "orders":
        return taking_part("baselines")[-1:]
    if table == "all":
        return (*dict.fromkeys((*taking_part("baselines")[:-1], *taking_part("single-vehicle"))),)
    place = re.compile(rf"^_tables_: .*\b{'baselines' if table == 'load' else table}: (\d+)", re.MULTILINE)
    texts = {file.stem: file.read_text(encoding="utf-8") for file in (conf_dir() / "method").glob("*.yaml")}
    places = {name: int(said[1]) for name, text in texts.items() if (said := place.search(text))}
    return tuple(sorted(places, key=places.__getitem__))


def styles() -> dict[str, tuple[str, str, str]]:
    """Return the colour, marker and stroke of the methods whose YAML says them."""
    texts = {name: file.read_text(encoding="utf-8") for name, file in choices("method").items()}
    return {name: (said[1], said[2], said[3]) for name, text in texts.items() if (said := _STYLE.search(text))}


def read_yaml(file: Path) -> str:
    """Return the text of a YAML.

    Raises:
        ConfigError: If it cannot be read.
    """
    try:
        return file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as err:
        raise ConfigError(
            f"{file} is not written in UTF-8 ({err.reason} at byte {err.start}); save it as UTF-8"
        ) from err
    except OSError as err:
        raise ConfigError(f"{file} cannot be read ({err.strerror}); change its permissions or take it away") from err


def describe(file: Path) -> str:
    """Return the sentence that a YAML begins with, or nothing."""
    lines = read_yaml(file).splitlines()
    first = next((line for line in lines if line.strip() and not line.startswith("# @package")), "")
    return first.removeprefix("#").strip() if first.startswith("#") else ""


def values(file: Path) -> dict[str, str]:
    """Return the keys of the top level of a YAML, and of one that it inherits from, with the text of their values."""
    found = _LINE.findall(read_yaml(file))
    own = {name: value.strip() for name, value in found if not name.startswith("_")}
    parent = _PARENT.match(own.pop("defaults", ""))
    return {**(values(conf_dir() / file.parent.name / f"{parent[1]}.yaml") if parent else {}), **own}


def chosen_in(file: Path, group: str) -> str | None:
    """Return what a YAML sets a group to."""
    return dict(_DEFAULT.findall(read_yaml(file))).get(group)


def target_of(file: Path) -> str | None:
    """Return the class that a YAML names, if it names one."""
    found = _TARGET.search(read_yaml(file))
    return found[1] if found else None


def default_choice(group: str, suite: Path | None = None) -> str | None:
    """Return what a group is set to when nothing is said, or only the suite."""
    files = (conf_dir() / "config.yaml", *([suite] if suite else []))
    choice = dict(pair for file in files for pair in _DEFAULT.findall(read_yaml(file))).get(group)
    return None if choice == "null" else choice


def config_folder(config_dir: object) -> Path | None:
    """Read what a caller from Python gives for ``--config-dir``.

    Raises:
        ConfigError: If it is no path.
    """
    if config_dir is None or isinstance(config_dir, str | Path):
        return None if config_dir is None else Path(config_dir)
    raise ConfigError(f"config_dir must be the path of a folder or None, got {config_dir!r:.100}")


def check_config_dir(config_dir: Path) -> None:
    """Refuse a folder of the user's that would be read otherwise than it looks.

    Raises:
        ConfigError: If the folder is missing, or one of its files has the name of one of ours.
    """
    if not config_dir.is_dir():
        raise ConfigError(f"--config-dir {config_dir} is not a folder")
    if (config_dir / "config.yaml").exists():
        raise ConfigError(
            f"{config_dir / 'config.yaml'} would never be read; put your YAML into {config_dir}/scenario/, ..."
        )
    for group in (*LISTED, STRESS):
        ours = choices(group)
        for name, file in choices(group, config_dir).items():
            if name == ALL:
                raise ConfigError(f"{file} is called {ALL}, which stands for every {group}; give it another name")
            if name in ours and file != ours[name] and file.resolve() != ours[name].resolve():
                raise ConfigError(f"{file} has the name of a built-in {group}; give it another name")
