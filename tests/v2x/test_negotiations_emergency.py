"""A drive with an emergency vehicle that is let through first."""

from agreeing import EXACT, ORDERS, codriving
from worlds import Junction

from codriving.datatypes.world import Kind, Start
from codriving.v2x.connected import V2X
from codriving.v2x.settings import OrderSettings


def arrivals(junction: Junction, emergency: str | None) -> dict[str, float]:
    """When each of three CAVs arrives; CAV1 turns left across the ways of the others [s]."""
    starts = [("CAV1", "south-west", 40.0), ("CAV2", "north-south", 38.0), ("CAV3", "west-east", 41.0)]
    environment = junction.drive(*(Start(name, Kind.CAV, route, place, 8.0) for name, route, place in starts))
    settings = V2X(**EXACT, coordination=OrderSettings(**{**ORDERS, "emergency": emergency}))
    method = settings.between(codriving(binding=True), ())
    environment.observer = method.observer
    world = environment.reset(0)
    method.reset(environment.road_map, environment.driving_model, 0)
    while (outcome := environment.outcome) is None:
        world = environment.step(method.act(world).actions)
    assert outcome.ending == "success"
    return dict(outcome.arrivals)


def test_an_emergency_vehicle_arrives_earlier_than_without(junction: Junction) -> None:
    plain, urgent = arrivals(junction, None), arrivals(junction, "CAV1")
    assert min(plain, key=plain.__getitem__) != "CAV1"
    assert urgent["CAV1"] < plain["CAV1"] - 1.0
    assert min(urgent, key=urgent.__getitem__) == "CAV1"
