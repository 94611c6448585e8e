"""A scene becomes vehicles on the road."""

from collections.abc import Mapping

from codriving.datatypes.scene import Scene
from codriving.datatypes.vehicle import Kind
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.control import ControlGains
from codriving.environment.traffic.driver_profile import DriverProfile
from codriving.environment.traffic.human_driver import HumanDriver
from codriving.environment.traffic.traffic import Traffic
from codriving.environment.traffic.way import Way


def spawn(
    traffic: Traffic,
    scene: Scene,
    ways: Mapping[str, Way],
    target_speeds: tuple[float, ...],
    control: ControlGains,
    drivers: DriverProfile,
) -> None:
    """Put everybody on the road, in the order of the scene.

    Args:
        target_speeds: Speeds that a CAV's FASTER and SLOWER step through [m/s].
    """
    corrections = traffic.corrections
    for start in scene.starts:
        vehicle = (
            ConnectedVehicle.start(traffic, start, ways, target_speeds, control, corrections)
            if start.kind is Kind.CAV
            else HumanDriver.start(traffic, start, ways, drivers, corrections)
        )
        traffic.vehicles.append(vehicle)
