"""The envelope of a world: how fast CAVs get on at each place of a route, how they lie there, and where it is kept."""

import csv
import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from io import StringIO
from pathlib import Path

import numpy as np

from codriving.environment import Environment
from codriving.errors import ConfigError
from codriving.geometry import FloatArray, RoadMap

SHIPPED = Path(__file__).parent / "envelopes"

BIN = 1.0  # Length of road over which extremes are taken together [m]

DIGITS = 4  # Values are rounded to so many decimals, away from what was measured

COLUMNS = ("route", "lead", "place", "pace", "left", "right", "least_turn", "most_turn")


@dataclass(frozen=True, slots=True, eq=False)
class Envelope:
    """What no CAV exceeds on a route; row k of an array holds from k to k + 1 m of arc length."""

    lead: float  # By how much a drive may be anywhere before the one that is FASTER for ever [s]
    pace: FloatArray  # Highest progress along the route (n,) [m/s]
    left: FloatArray  # Lowest lateral offset (n,) [m]
    right: FloatArray  # Highest lateral offset (n,) [m]
    least_turn: FloatArray  # Lowest heading against that of the route (n,) [rad]
    most_turn: FloatArray  # Highest heading against that of the route (n,) [rad]

    @property
    def corners(self) -> tuple[tuple[FloatArray, FloatArray], ...]:
        """The extreme poses: lateral offset and heading of each, for every row."""
        return tuple((side, turn) for side in (self.left, self.right) for turn in (self.least_turn, self.most_turn))


Envelopes = Mapping[str, Envelope]  # Of every route


def alike(road_map: RoadMap) -> Mapping[str, str]:
    """Return for each route the first one of the same shape: it can be turned and shifted onto that one."""
    first: dict[tuple[object, ...], str] = {}
    found = {}
    for name, path in road_map.paths.items():
        turns = np.round(path.headings - path.headings[0], 4) + 0.0
        shape = (round(road_map.routes[name].goal, 3), round(path.length, 3), turns.tobytes())
        found[name] = first.setdefault(shape, name)
    return found


def world_hash(environment: Environment) -> str:
    """Return what tells the worlds apart in which lone CAVs drive differently: road, control, limits and actions."""
    pace = environment.scenario.pace
    frequencies = (pace.simulation_frequency, pace.decision_frequency, pace.target_speeds)
    # Buildings hide vehicles from one another, and a CAV that is alone drives past them.
    road = replace(environment.scenario.road, buildings=())
    parts = (road, environment.control, environment.limits, frequencies, environment.corrections)

    def rounded(match: re.Match[str]) -> str:
        return f"{float(match[0]) + 0.0:.5f}".replace("-0.00000", "0.00000")

    # The last digits of sines differ from machine to machine.
    text = re.sub(r"-?\d+\.\d+(e[+-]?\d+)?", rounded, repr(parts))
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def file_name(environment: Environment) -> str:
    """Name the file of a world."""
    return f"{environment.scenario.name}-{world_hash(environment)}.csv"


def load(environment: Environment, folder: Path | None = None) -> Envelopes:
    """Read the envelope of a world from the package, or from a folder where it was measured.

    Raises:
        ConfigError: If the envelope of this world was never measured.
    """
    name = file_name(environment)
    for place in (SHIPPED, *([] if folder is None else [folder])):
        if (place / name).is_file():
            return read(place / name, environment.road_map)
    raise ConfigError(
        f"no envelope was measured for this {environment.scenario.name}: its road, control, limits or actions differ "
        f"from those of {SHIPPED.name}/ ({name} is missing); measure it with codriving bound --measure and the "
        "same settings, which takes some minutes"
    )


def read(file: Path, road_map: RoadMap) -> Envelopes:
    """Read the envelopes of all routes from a file, which holds those of the first of each shape."""
    measured = _measured(file)
    return {name: measured[first] for name, first in alike(road_map).items()}


@lru_cache(maxsize=16)
def _measured(file: Path) -> Envelopes:
    rows: dict[str, list[list[float]]] = {}
    leads: dict[str, float] = {}
    with file.open(encoding="utf-8", newline="") as lines:
        for row in csv.DictReader(lines):
            rows.setdefault(row["route"], []).append([float(row[column]) for column in COLUMNS[3:]])
            leads[row["route"]] = float(row["lead"])
    return {name: Envelope(leads[name], *np.array(values).T.copy()) for name, values in rows.items()}


def text_of(envelopes: Envelopes) -> str:
    """Write envelopes down, one row a metre."""
    out = StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    for name, one in envelopes.items():
        for k, row in enumerate(zip(one.pace, one.left, one.right, one.least_turn, one.most_turn, strict=True)):
            lows = (False, True, False, True, False)
            values = (_outwards(value, low) for value, low in zip(row, lows, strict=True))
            writer.writerow((name, _outwards(one.lead, False), f"{k * BIN:g}", *values))
    return out.getvalue()


def _outwards(value: float, low: bool) -> str:
    scaled = value * 10**DIGITS
    return f"{(np.floor(scaled) if low else np.ceil(scaled)) / 10**DIGITS:.{DIGITS}f}"
