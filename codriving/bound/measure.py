"""Measures the envelope of a world: CAVs that are alone on the road and take actions at random."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from codriving.bound.envelope import BIN, Envelope, alike
from codriving.bound.passing import times_at
from codriving.datatypes import Action, Kind, Outcome, Road, Scenario, Scene, Start
from codriving.environment import Environment
from codriving.geometry import FloatArray, Path, corners

DRIVES = 400  # Drives with actions at random, for each shape of a route

PAIRS = 200  # Drives that are FASTER but for some decisions, against those that are FASTER for ever, likewise

LONGEST = 60.0  # A drive that has not arrived by then is over [s]

LATEST = 15.0  # No drive starts nearer to the junction, as in the scenarios [m]

NEAR = 60.0  # Most start nearer than this to the junction [m]

# A CAV that almost stands wavers by so much to either side [m], [rad], too seldom to be seen at every place.
WAVER = (0.05, 0.05, 0.02, 0.02)

QUICKER = 0.002  # What is added to the pace that was seen [m/s]

SPEEDS = (Action.SLOWER, Action.IDLE, Action.HOLD, Action.FASTER)

Chooser = Callable[[int], Action]


class Lone(Scenario):
    """CAVs that are put on the road of a scenario."""

    def __init__(self, scenario: Scenario) -> None:
        self.name, self.pace, self._road = scenario.name, scenario.pace, scenario.road
        self.starts: tuple[Start, ...] = ()

    @property
    def road(self) -> Road:
        """The road of the scenario."""
        return self._road

    def scene(self, seed: int) -> Scene:
        """Put them where they start."""
        return Scene(seed, self.starts)


@dataclass(frozen=True, slots=True, eq=False)
class LoneDrive:
    """What one CAV drove, seen from its route; one row a simulation step."""

    places: FloatArray  # Arc length (n,) [m]
    offsets: FloatArray  # Lateral offset (n,) [m]
    turns: FloatArray  # Heading against that of the route (n,) [rad]
    driven: FloatArray  # Metres driven (n,) [m]
    corners: FloatArray  # Corners of its body (n, 4, 2) [m]
    arrived: bool


class LoneRoad:
    """Drives CAVs alone in the world of an environment, HOLD included."""

    def __init__(self, environment: Environment) -> None:
        self._scenario = Lone(environment.scenario)
        parts = (environment.control, environment.drivers, environment.corrections, environment.limits)
        self._environment = Environment(self._scenario, *parts, None, True)
        self.road_map, self.model = self._environment.road_map, self._environment.driving_model

    def drive(self, start: Start, choose: Chooser) -> LoneDrive:
        """Drive from a start; the function gives the action of each decision."""
        self._scenario.starts = (start,)
        world = self._environment.reset(0)
        while self._environment.outcome is None and world.time < LONGEST:
            world = self._environment.step({start.id: choose(world.step)})
        (track,) = self._environment.trajectory().tracks
        path = self.road_map.paths[start.route]
        places, offsets = projected(path, track.x, track.y, start.position)
        turns = (track.heading - path.heading(places) + np.pi) % (2 * np.pi) - np.pi
        driven = np.concatenate(([0.0], np.cumsum(track.speed[:-1]) * self.model.step))
        body = corners(track.x, track.y, track.heading, track.length, track.width)
        return LoneDrive(places, offsets, turns, driven, body, track.arrived is not None)

    def together(self, starts: Sequence[Start], plans: Mapping[str, Sequence[Action]]) -> Outcome | None:
        """Drive several CAVs by plans whose last action is repeated; None if that takes too long."""
        self._scenario.starts = tuple(starts)
        world = self._environment.reset(0)
        while self._environment.outcome is None and world.time < LONGEST:
            chosen = {name: plans[name][min(world.step, len(plans[name]) - 1)] for name in world.available}
            world = self._environment.step(chosen)
        return self._environment.outcome


def projected(path: Path, x: FloatArray, y: FloatArray, place: float) -> tuple[FloatArray, FloatArray]:
    """Return arc lengths and lateral offsets of a track (n,) [m], as the environment follows it along the route."""
    found = []
    for point in zip(x.tolist(), y.tolist(), strict=True):
        found.append(path.project(*point, near=place))
        place = found[-1][0]
    places, offsets = np.array(found).T
    return places, offsets


def measure(
    environment: Environment, drives: int = DRIVES, pairs: int = PAIRS, seed: int = 1
) -> Mapping[str, Envelope]:
    """Measure the envelope of each shape of a route, by the first route of that shape."""
    road = LoneRoad(environment)
    found = {}
    for name in dict.fromkeys(alike(road.road_map).values()):
        rng = np.random.default_rng(np.random.SeedSequence(entropy=seed, spawn_key=tuple(name.encode())))
        found[name] = _measure_route(road, name, rng, drives, pairs)
    return found


def random_start(road: LoneRoad, route: str, rng: np.random.Generator) -> Start:
    """Draw where and how fast a drive starts."""
    latest = max(road.road_map.routes[route].entry - LATEST, 1.0)
    first = max(latest - NEAR, 0.0) if rng.random() < 0.8 else 0.0
    speed = float(rng.uniform(0.0, road.model.top_speed))
    return Start("CAV1", Kind.CAV, route, float(rng.uniform(first, latest)), speed)


def random_actions(rng: np.random.Generator) -> Chooser:
    """Draw how a drive goes on: an action is kept for a while, and drives differ in which they like."""
    liked = rng.dirichlet((0.7, 0.7, 0.7, 1.5))
    keeps = float(rng.uniform(0.2, 0.9))
    now = [Action.FASTER]

    def choose(step: int) -> Action:
        if step == 0 or rng.random() > keeps:
            now[0] = SPEEDS[int(rng.choice(len(SPEEDS), p=liked))]
        return now[0]

    return choose


def _nearly_fastest(rng: np.random.Generator) -> Chooser:
    share = float(rng.uniform(0.05, 0.5))
    return lambda _: SPEEDS[int(rng.integers(len(SPEEDS)))] if rng.random() < share else Action.FASTER


def _fastest(_: int) -> Action:
    return Action.FASTER


def _measure_route(road: LoneRoad, name: str, rng: np.random.Generator, drives: int, pairs: int) -> Envelope:
    path, goal = road.road_map.paths[name], road.road_map.routes[name].goal
    rows = int(np.ceil(goal / BIN)) + 2
    extremes = np.zeros((5, rows))
    profile = road.road_map.speed_profiles(road.model).get(name)
    ends = BIN * np.arange(rows + 1)
    caps = np.full(rows + 1, road.model.top_speed)
    if profile is not None:
        caps = np.minimum(caps, np.interp(ends, path.arc_lengths, profile.speeds))
    # What is not seen because no drive happened to be that fast there is allowed nevertheless.
    extremes[0] = np.maximum(caps[:-1], caps[1:])
    lead = 0.0
    for k in range(drives + pairs):
        start = random_start(road, name, rng)
        if k < drives:
            _widen(extremes, road.drive(start, random_actions(rng)), road.model.step)
            continue
        fastest, other = road.drive(start, _fastest), road.drive(start, _nearly_fastest(rng))
        for drive in (fastest, other):
            _widen(extremes, drive, road.model.step)
        lead = max(lead, _ahead(fastest.places, other.places, goal) * road.model.step)
    return Envelope(lead, *_smeared(extremes))


def _widen(extremes: FloatArray, drive: LoneDrive, step: float) -> None:
    last = extremes.shape[1] - 1
    rows = np.clip((drive.places / BIN).astype(np.intp), 0, last)
    pace = np.diff(drive.places) / step
    for more in range(int(np.max(rows[1:] - rows[:-1], initial=0)) + 1):
        np.maximum.at(extremes[0], np.minimum(rows[:-1] + more, rows[1:]), pace)
    np.minimum.at(extremes[1], rows, drive.offsets)
    np.maximum.at(extremes[2], rows, drive.offsets)
    np.minimum.at(extremes[3], rows, drive.turns)
    np.maximum.at(extremes[4], rows, drive.turns)


def _smeared(extremes: FloatArray) -> FloatArray:
    """Let each row allow what its neighbours do, and wavering."""
    found = np.empty_like(extremes)
    # A metre more or less of the pace costs the bound time, and drives see every metre of it.
    found[0] = extremes[0] + QUICKER
    for k, row in enumerate(extremes[1:], start=1):
        windows = np.lib.stride_tricks.sliding_window_view(np.pad(row, 1, "edge"), 3)
        waver = WAVER[k - 1]
        found[k] = windows.max(axis=1) + waver if k % 2 == 0 else windows.min(axis=1) - waver
    return found


def _ahead(fastest: FloatArray, other: FloatArray, goal: float) -> float:
    """By how many steps the other drive is at some place before the fastest one, at most."""
    places = np.linspace(fastest[0], min(goal, fastest[-1], other[-1]), 400)[1:]
    return float(np.max(times_at(fastest, places, 1.0) - times_at(other, places, 1.0), initial=0.0))
