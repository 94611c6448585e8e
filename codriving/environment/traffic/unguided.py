"""CAVs for which nothing decides: each drives as an attentive human driver does, on a route of its own."""

import math

from codriving.datatypes import Action, Kind, Start
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.drivers.style import DriverMix
from codriving.environment.settings import DriverProfile
from codriving.environment.traffic.human_driver import HumanDriver
from codriving.environment.traffic.traffic import Traffic


class UnguidedVehicle(HumanDriver):
    """A CAV by IDM, MOBIL and the right of way; it takes no actions, and nothing of it is drawn."""

    kind = Kind.CAV
    most = math.inf  # Speed that it wants at most [m/s]

    @property
    def target_speed(self) -> float:
        """Speed that it wants [m/s]: after a wait human drivers want the speed limit, and CAVs no more than before."""
        return min(self._wanted, self.most)

    @target_speed.setter
    def target_speed(self, speed: float) -> None:
        self._wanted = speed

    def randomize_behavior(self) -> None:
        """Keep what IDM has: a draw would be one less for the human drivers."""

    def available(self) -> tuple[Action, ...]:
        """Return the actions that it can take: none."""
        return ()


def take_over(traffic: Traffic, drivers: DriverProfile | DriverMix, top_speed: float) -> None:
    """Put an unguided vehicle in the place of each CAV that takes actions; it wants the highest target speed [m/s]."""
    traits = drivers.typical() if isinstance(drivers, DriverMix) else None

    def unguided(cav: ConnectedVehicle) -> UnguidedVehicle:
        start = Start(cav.id, Kind.CAV, cav.route_path.route.id, cav.s, cav.speed)
        vehicle = UnguidedVehicle.start(traffic, start, cav.route_paths, drivers, cav.corrections, traits)
        vehicle.style, vehicle.most, vehicle.target_speed = "", top_speed, top_speed
        return vehicle

    traffic.exchange([unguided(v) if isinstance(v, ConnectedVehicle) else v for v in traffic.vehicles])
