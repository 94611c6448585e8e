"""Who drives and where they start: seeded rejection sampling that leaves all room to brake."""

import math
from abc import abstractmethod
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from codriving.datatypes import Kind, Road, Scenario, Scene, Start
from codriving.environment.scenarios.pace import Pace
from codriving.errors import ScenarioError, require_interval, require_range

DRAWS_PER_VEHICLE = 200
SCENES = 200

Suits = Callable[[Sequence[Start]], bool]  # Whether a scene may be as it was drawn

Draw = Callable[[np.random.Generator, str, Kind], Start]  # Draws one vehicle, given its name and who drives it

LENGTH = 5.0  # Vehicle length [m]

# Maps a start to the lane that it stands on, by any name, and its place along it [m].
Spot = Callable[[Start], tuple[Hashable, float]]


@dataclass(frozen=True, slots=True)
class Crowd:
    """How many CAVs and human drivers there are, and how they start."""

    cavs: int
    hdvs: tuple[int, int]
    start: tuple[float, float]  # Nearest and farthest start along a route [m]
    cav_speed: tuple[float, float]  # Lowest and highest start speed of CAVs [m/s]
    hdv_speed: tuple[float, float]  # Lowest and highest start speed of HDVs, which is also the speed they want [m/s]
    spacing: float  # Smallest distance between two starts on one lane [m]

    def check(self, cavs: int, hdvs: int, latest: float, why: str, speed_limit: float) -> None:
        """Refuse what is out of range.

        Args:
            latest: Farthest start allowed [m].
            speed_limit: Speed limit where they start [m/s].

        Raises:
            ConfigError: With the setting and its range.
        """
        require_range("cavs", self.cavs, 2, cavs)
        require_interval("hdvs", self.hdvs, 0, hdvs)
        require_interval("start", self.start, 0, latest, f" m ({why})")
        require_interval("cav_speed", self.cav_speed, 0, speed_limit, " m/s")
        require_interval("hdv_speed", self.hdv_speed, 1, speed_limit, " m/s")
        require_range("spacing", self.spacing, 6, 200, " m")

    @property
    def room(self) -> int:
        """Largest number of vehicles that can start on one lane, even if all draws fall as they should."""
        apart = self.apart(min(self.cav_speed[0], self.hdv_speed[0]))
        return 1 + math.floor((self.start[1] - self.start[0]) / apart)

    def apart(self, speed: float) -> float:
        """Smallest distance between two starts on one lane at the same speed [m]."""
        return max(self.spacing, LENGTH + braking_gap(speed, speed))

    def require_room(self, lanes: int, where: str, cavs: int | None = None, hdvs: int | None = None) -> None:
        """Refuse more vehicles than can start, even if all draws fall as they should.

        Args:
            where: The lanes in words, for instance ``4 legs``.

        Raises:
            ScenarioError: If there is not enough room.
        """
        cavs, hdvs = self.cavs if cavs is None else cavs, self.hdvs[1] if hdvs is None else hdvs
        if cavs + hdvs > lanes * self.room:
            raise ScenarioError(
                f"{cavs} CAVs and up to {hdvs} HDVs cannot start within {self.start[0]:g} to {self.start[1]:g} m "
                f"along {where}, where {lanes * self.room} vehicles have {self.spacing:g} m and a braking gap between "
                "them at most; use fewer vehicles or a longer start interval"
            )

    def start_on(
        self, rng: np.random.Generator, name: str, kind: Kind, route: str, between: tuple[float, float] | None = None
    ) -> Start:
        """Draw place and speed of one vehicle.

        Args:
            between: Nearest and farthest start along the route, if not ``start`` [m].
        """
        position = float(rng.uniform(*(between or self.start)))
        speed = float(rng.uniform(*(self.cav_speed if kind is Kind.CAV else self.hdv_speed)))
        return Start(name, kind, route, position, speed)


def place(
    seed: int,
    crowd: Crowd,
    road: Road,
    draw: Draw,
    spot: Spot | None = None,
    loops: Mapping[Hashable, float] | None = None,
    suits: Suits | None = None,
) -> Scene:
    """Draw a whole scene.

    Args:
        loops: Length of each lane that runs in a circle [m].
        suits: What has to hold of all starts; None takes every scene.

    Raises:
        ScenarioError: If the vehicles do not fit.
    """
    first = {route.id: route.lanes[0] for route in road.routes}
    where: Spot = spot or (lambda start: (first[start.route], start.position))
    rng = np.random.default_rng(np.random.SeedSequence(entropy=seed, spawn_key=(0,)))
    number = int(rng.integers(crowd.hdvs[0], crowd.hdvs[1] + 1))
    names = [(f"CAV{i + 1}", Kind.CAV) for i in range(crowd.cavs)] + [(f"HDV{i + 1}", Kind.HDV) for i in range(number)]
    fitted = False
    for _ in range(SCENES):
        starts: list[Start] = []
        for name, kind in names:
            for _ in range(DRAWS_PER_VEHICLE):
                start = draw(rng, name, kind)
                if leaves_room(start, starts, where, crowd.spacing, loops):
                    starts.append(start)
                    break
            else:
                break
        if len(starts) == len(names):
            if suits is None or suits(starts):
                return Scene(seed=seed, starts=tuple(starts))
            fitted = True
    if fitted:
        raise ScenarioError(
            f"{road.name}: of {SCENES} scenes drawn for seed {seed} none has what the settings ask of all starts "
            "together, such as an exit that two CAVs want; use more CAVs or other settings"
        )
    raise ScenarioError(
        f"{road.name} with starts {crowd.start[0]:g} to {crowd.start[1]:g} m: {crowd.cavs} CAVs and {number} HDVs "
        f"do not fit with {crowd.spacing:g} m and a braking gap between them (seed {seed}); use fewer vehicles or a "
        "longer start interval"
    )


def braking_gap(follower: float, leader: float) -> float:
    """Return the smallest bumper gap [m] at which a follower can still brake behind its leader, by their speeds [m/s].

    It is 2 m plus 0.8 s of travel plus the difference of the stopping distances at 4 m/s2.
    """
    return 2.0 + 0.8 * follower + max(0.0, (follower**2 - leader**2) / 8.0)


def leaves_room(
    start: Start, others: Sequence[Start], spot: Spot, spacing: float, loops: Mapping[Hashable, float] | None = None
) -> bool:
    """Whether a start is far enough from the others on the same lane."""
    lane, place = spot(start)
    for other in others:
        lane_2, place_2 = spot(other)
        if lane != lane_2:
            continue
        distance = place - place_2
        if loops and lane in loops:
            distance = math.remainder(distance, loops[lane])
        ahead, behind = (start, other) if distance > 0 else (other, start)
        distance = abs(distance)
        if distance < max(spacing, LENGTH + braking_gap(behind.speed, ahead.speed)):
            return False
    return True


@dataclass(kw_only=True, eq=False, repr=False)
class PlacedScenario(Scenario):
    """A scenario with the settings of `Crowd` and `Pace`, whose vehicles are drawn one by one."""

    cavs: int
    hdvs: tuple[int, int]
    start: tuple[float, float]
    cav_speed: tuple[float, float]
    hdv_speed: tuple[float, float]
    spacing: float
    simulation_frequency: float
    decision_frequency: float
    time_limit: float
    target_speeds: tuple[float, ...]
    detection_range: float

    def __post_init__(self) -> None:
        self.crowd = Crowd(self.cavs, self.hdvs, self.start, self.cav_speed, self.hdv_speed, self.spacing)
        self.check()
        self.pace = Pace(
            self.simulation_frequency,
            self.decision_frequency,
            self.time_limit,
            tuple(self.target_speeds),
            self.detection_range,
        )

    @abstractmethod
    def check(self) -> None:
        """Refuse settings that are out of range, and more vehicles than there is room for."""

    @abstractmethod
    def draw(self, rng: np.random.Generator, name: str, kind: Kind) -> Start:
        """Draw where one vehicle starts."""

    def scene(self, seed: int) -> Scene:
        """Draw a start for every vehicle."""
        return place(seed, self.crowd, self.road, self.draw)

    def arrival(self, rng: np.random.Generator, name: str, kind: Kind, route: str) -> Start:
        """Let a vehicle of a flow come in at the edge of the road, at a start speed."""
        return self.crowd.start_on(rng, name, kind, route, (LENGTH / 2, LENGTH / 2))
