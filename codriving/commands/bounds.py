"""`codriving bound`: how fast the CAVs of each seed can arrive at most, and what was solved before."""

import csv
import hashlib
import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from codriving.bound import BoundedWorld, Margins, bounded_world, witness
from codriving.config import build, changed_worlds, expand
from codriving.datatypes import Simulator
from codriving.errors import ConfigError
from codriving.experiment import cell_name, composed, suite_of, swept_values, validated
from codriving.reports import BoundRow, print_bounds, print_table
from codriving.runs import BEHAVIOUR, locked, new_run_path, unwritable, write_text

FILE = "bound.csv"

COLUMNS = ("world", "scenario", "seed", "cavs", "bound", "driven", "alone", "binaries", "optimal")

ENVELOPES = "envelopes"  # Folder below the output, for those that are measured

NOT_FOUND = "none"  # In place of a drive that was looked for

Row = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class BoundOptions:
    """What ``codriving bound`` takes besides settings."""

    measure: bool = False  # Whether a missing envelope is measured
    margin: float | None = None  # Time that an executor keeps at zones [s]; None bounds all ways of driving
    one_order: bool = False  # Whether CAVs keep one order of vehicles
    driven: bool = False  # Whether a drive is looked for that is as fast as can be
    config_dir: Path | None = None

    @property
    def margins(self) -> Margins | None:
        """What the executor keeps."""
        return None if self.margin is None else Margins(self.margin)

    def check(self) -> None:
        """Refuse what is out of range."""
        if self.margin is not None and not 0 <= self.margin <= 5:
            raise ConfigError(f"--margin must be 0 to 5 s, got {self.margin:g}")
        if self.driven and self.margin is not None:
            raise ConfigError("--driven keeps no margins, so it says nothing beside --margin; leave one of them out")
        if self.one_order and self.margin is None:
            raise ConfigError("--one-order needs --margin: without margins the bound holds for all orders")


def world_of(
    resolved: Mapping[str, Any], measured: Path, options: BoundOptions | None = None
) -> tuple[BoundedWorld, str]:
    """Make the world of a config, and the mark that tells its bounds from those of others.

    Args:
        measured: Folder with envelopes that were measured before.

    Raises:
        ConfigError: If no bound is defined in it, or its envelope was not measured.
    """
    options = options or BoundOptions()
    environment = build(resolved["environment"], Simulator, "environment", resolved["plugins"])
    world = bounded_world(environment, measured, options.margins, options.one_order, options.measure)
    if options.driven and world.envelopes is None:
        raise ConfigError(f"--driven needs zones, and CAVs choose their lanes at {world.name}; leave it out there")
    parts = [BEHAVIOUR, resolved["environment"], world.settings]
    return world, hashlib.sha256(json.dumps(parts, sort_keys=True, default=str).encode()).hexdigest()[:12]


@dataclass
class KeptBounds:
    """The bounds in a folder, which are solved once."""

    folder: Path
    rows: dict[tuple[str, int], Row] = field(default_factory=dict)

    @classmethod
    def of(cls, folder: Path) -> "KeptBounds":
        """Read what is there; what cannot be read is solved anew."""
        kept = cls(folder)
        try:
            with (folder / FILE).open(encoding="utf-8", newline="") as file:
                for row in csv.DictReader(file):
                    if set(COLUMNS) <= row.keys() and row["seed"].isdecimal() and _is_number(row["bound"]):
                        kept.rows[row["world"], int(row["seed"])] = row
        except (OSError, UnicodeDecodeError, csv.Error):
            pass
        return kept

    def row(self, world: BoundedWorld, mark: str, seed: int, driven: bool = False) -> Row:
        """Return the bound of a seed, solved if it is not there."""
        found = self.rows.get((mark, seed))
        if found is None or (driven and not found["driven"]):
            found = self.rows[mark, seed] = _row(world, mark, seed, driven)
            write_text(self.folder / FILE, self.text())
        return found

    def text(self) -> str:
        """Write all bounds down."""
        out = io.StringIO()
        writer = csv.DictWriter(out, COLUMNS, lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        writer.writerows(row for _, row in sorted(self.rows.items()))
        return out.getvalue()


def _is_number(text: str | None) -> bool:
    try:
        return float(text or "") >= 0
    except ValueError:
        return False


def _row(world: BoundedWorld, mark: str, seed: int, driven: bool) -> Row:
    bound, total = world.solve(seed), ""
    if driven:
        found = witness(world, seed, bound)
        total = NOT_FOUND if found is None else f"{found.total:.1f}"
    values = (mark, world.name, str(seed), str(bound.cavs), f"{bound.total:.1f}", total, f"{bound.alone:.1f}")
    return dict(zip(COLUMNS, (*values, str(bound.binaries), "yes" if bound.optimal else "no"), strict=True))


def run_bound(overrides: Sequence[str], options: BoundOptions) -> int:
    """Do what ``codriving bound`` does; of several configs those without a bound are left out with a line.

    Args:
        overrides: ``key=value`` tokens.

    Raises:
        UserError: If the config or the folder cannot be used, or no bound is defined.
    """
    options.check()
    base = () if any(token.lstrip("+").startswith("experiment=") for token in overrides) else ("experiment=bound",)
    points = expand([*base, *overrides], options.config_dir)
    configs, _ = composed(points, options.config_dir)
    validated(points, configs)
    first = configs[0]
    if first["shard"] is not None:
        raise ConfigError("codriving bound has no shards; give each process seeds of its own, seed= and episodes=")
    output = Path(first["output"])
    worlds, left_out = [], []
    for point, config in zip(points, configs, strict=True):
        try:
            worlds.append((point, config, world_of(config, output / ENVELOPES, options)))
        except ConfigError as refusal:
            left_out.append((point, refusal))
    if not worlds:
        raise left_out[0][1]
    experiment = output / first["experiment"]
    folder = experiment / first["run"] if first["run"] else new_run_path(experiment, datetime.now(UTC))
    seeds = range(first["seed"], first["seed"] + first["episodes"])
    rows = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with locked(folder):
            kept = KeptBounds.of(folder)
            for point, config, (world, mark) in worlds:
                try:
                    solved = [kept.row(world, mark, seed, options.driven) for seed in seeds]
                except ConfigError as refusal:
                    left_out.append((point, refusal))
                    continue
                swept = swept_values(point.swept, config)
                rows.append(BoundRow.of(world.name, swept, solved, world.envelopes is not None))
    except OSError as error:
        raise unwritable(folder, error) from error
    if not rows:
        raise left_out[0][1]
    notes = [f"{cell_name(point)} is left out: {refusal}." for point, refusal in left_out]
    notes += changed_worlds([suite_of(point) for point in points], configs, options.config_dir)
    print_table(print_bounds(rows, options.margin, options.one_order).with_notes(notes))
    print(folder / FILE)
    return 0
