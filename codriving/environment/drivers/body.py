"""A body as a driver sees it."""

from highway_env.vehicle.objects import RoadObject

# What is seen, where it is taken to be [m, m], its heading [rad] and its speed [m/s].
Body = tuple[RoadObject, float, float, float, float]


def body(thing: RoadObject) -> Body:
    """Return a body as it is."""
    x, y = thing.position.tolist()
    return thing, x, y, float(thing.heading), float(thing.speed)
