"""`codriving memory build`: episodes to learn from, on seeds that no table uses, into one file a cell."""

import re
from collections.abc import Sequence
from pathlib import Path

from codriving.commands.run import Command
from codriving.config import Point, expand, parse, written
from codriving.errors import ConfigError
from codriving.experiment import Driven, Outputs, Plan, learns, memory_file, results_of
from codriving.memory import read_memory
from codriving.reports import BuiltMemory, markdown_text, print_built

INTERACTIONS = "interactions"  # The word for how many episodes to learn from

FIRST_SEED = 20_000  # Seed of the first episode to learn from, if the user names none

TABLE_SEEDS = (range(10_000), range(100_000, 110_000))  # Seeds that tables are made with

MOST = 10_000  # Most interactions of one command


def build_points(overrides: Sequence[str], config_dir: Path | None = None) -> list[Point]:
    """Find out what is to be driven."""
    given, others = split_interactions(written(overrides))
    keys = {token: parse(token).key_or_group for token in others}
    named = set(keys.values())
    if "episodes" in named:
        raise ConfigError("codriving memory build takes interactions=N; each interaction is one episode")
    count = [20, *map(interactions_of, given)][-1]
    if any(key == "memory" and token.partition("=")[2] != "online" for token, key in keys.items()):
        raise ConfigError("codriving memory build learns with memory=online; other choices recall and learn nothing")
    base = ["memory=online", f"episodes={count}"]
    base += [] if "experiment" in named else ["experiment=memory"]
    base += [] if "seed" in named else [f"seed={FIRST_SEED}"]
    points = [Point((*base, *p.overrides), p.swept, p.removed) for p in expand(others, config_dir)]
    seeds = [seed for t in others if keys[t] == "seed" and (seed := count_of(t.partition("=")[2])) is not None]
    if any(seed < taken.stop and taken.start < seed + count for seed in seeds for taken in TABLE_SEEDS):
        raise ConfigError(
            f"seeds {seeds[-1]} to {seeds[-1] + count - 1} are no seeds to learn from: those below 10000, and 100000 "
            f"to 109999, are for tables, and what was learnt on them would be tested on them; choose seed={FIRST_SEED}"
        )
    return points


def split_interactions(overrides: Sequence[str]) -> tuple[list[str], list[str]]:
    """Give the values of ``interactions=``, and the other tokens."""
    own = [token for token in overrides if token.lstrip("+").partition("=")[0] == INTERACTIONS]
    return [token.partition("=")[2] for token in own], [token for token in overrides if token not in own]


def interactions_of(text: str) -> int:
    """Read a number of interactions."""
    count = count_of(text)
    if count is None or not 1 <= count <= MOST:
        raise ConfigError(f"interactions must be a whole number, 1 to {MOST}, got {text!r:.100}")
    return count


def count_of(text: str) -> int | None:
    """Read a whole number of plain digits; None for any other text, for instance a raised 2."""
    return int(text) if re.fullmatch(r"[0-9]{1,18}", text) else None


def built(driven: Driven) -> Outputs:
    """Say what was learnt."""
    rows = []
    for cell, records in zip(driven.cells, driven.records, strict=True):
        named = (cell.resolved.get("memory") or {}).get("file")
        reading = read_memory(memory_file(driven.folder, cell.folder) if named is None else Path(named))
        labels = cell.labels
        name = f"{labels.method} {labels.variant}".strip()
        rows.append(BuiltMemory(labels.scenario, name, labels.reasoner, reading, results_of(cell, records, cell.swept)))
    display = print_built(rows).with_notes(driven.notes)
    return Outputs({"memory.md": markdown_text(display).encode()}, (display,))


def refuse_forgetful(plan: Plan) -> None:
    """Refuse a method that would remember nothing."""
    for cell in plan.cells:
        if not learns(cell.resolved):
            raise ConfigError(f"method {cell.labels.method!r} has no memory to build; choose one that has")


BUILD = Command("memory build", build_points, refuse_forgetful, built)
