"""The settings that every scenario shares on who drives: how many, how fast, and from where."""

from dataclasses import dataclass

import numpy as np

from codriving.datatypes.scene import Start
from codriving.datatypes.vehicle import Kind
from codriving.environment.scenarios.gaps import room_on_lane
from codriving.errors import ScenarioError, require_interval, require_range


@dataclass(frozen=True, slots=True)
class Crowd:
    """How many CAVs and human drivers there are, and how they start.

    Attributes:
        start: Nearest and farthest start along a route [m].
        cav_speed: Lowest and highest start speed of CAVs [m/s].
        hdv_speed: Lowest and highest start speed of HDVs, which is also the speed they want [m/s].
        spacing: Smallest distance between two starts on one lane [m].
    """

    cavs: int
    hdvs: tuple[int, int]
    start: tuple[float, float]
    cav_speed: tuple[float, float]
    hdv_speed: tuple[float, float]
    spacing: float

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
        """Largest number of vehicles that can start on one lane."""
        slowest = min(self.cav_speed[0], self.hdv_speed[0])
        return room_on_lane(self.start[1] - self.start[0], slowest, self.spacing)

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
        self,
        rng: np.random.Generator,
        name: str,
        kind: Kind,
        route: str,
        between: tuple[float, float] | None = None,
    ) -> Start:
        """Draw place and speed of one vehicle.

        Args:
            between: Nearest and farthest start along the route, if not ``start`` [m].
        """
        position = float(rng.uniform(*(between or self.start)))
        speed = float(rng.uniform(*(self.cav_speed if kind is Kind.CAV else self.hdv_speed)))
        return Start(name, kind, route, position, speed)
