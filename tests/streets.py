"""Roads that vehicles come in on: parallel streets, a narrow one driven from both ends, the intersection."""

import numpy as np

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.flow import Flow
from codriving.datatypes.parts import Scenario
from codriving.datatypes.road import Lane, Road, Route, Straight, Turn
from codriving.datatypes.world import Action, Kind, Scene, Start
from codriving.environment.environment import Environment
from codriving.environment.scenarios.pace import Pace
from codriving.environment.settings import ControlGains, Corrections, DriverProfile

# A street that is driven from both ends at once.
NARROW = Road(
    "narrow",
    (
        Lane(("a", "b", 0), Straight((0.0, 0.0), (200.0, 0.0))),
        Lane(("c", "d", 0), Straight((200.0, 0.0), (0.0, 0.0))),
    ),
    (
        Route("there", (("a", "b", 0),), Turn.STRAIGHT, 100.0, 190.0),
        Route("back", (("c", "d", 0),), Turn.STRAIGHT, 100.0, 190.0),
    ),
)


def parallel(number: int) -> Road:
    """So many streets; the first one is the way to two goals."""
    lanes = [Lane((f"a{k}", f"b{k}", 0), Straight((0.0, 20.0 * k), (200.0, 20.0 * k))) for k in range(number)]
    routes = [Route(f"r{k}", (lane.id,), Turn.STRAIGHT, 100.0, 190.0) for k, lane in enumerate(lanes)]
    further = Route("near", (lanes[0].id,), Turn.STRAIGHT, 100.0, 150.0)
    return Road("streets", tuple(lanes), (*routes, further))


class Silent(Scenario):
    """A scenario that takes no flows."""

    name = "by hand"

    def __init__(self, built: Road) -> None:
        self.built, self.pace = built, Pace(10.0, 2.0, 50.0, (0.0, 3.0, 6.0, 9.0), 50.0)

    @property
    def road(self) -> Road:
        """The road."""
        return self.built

    def scene(self, seed: int) -> Scene:
        """None but those who come in."""
        return Scene(seed, ())


class Streets(Silent):
    """Vehicles come in at 7 to 9 m/s."""

    def arrival(self, rng: np.random.Generator, name: str, kind: Kind, route: str) -> Start:
        return Start(name, kind, route, 2.5, float(rng.uniform(7, 9)))


def environment(scenario: Scenario, flow: Flow) -> Environment:
    """An environment as it is configured."""
    node = compose(["suite=paper"])["environment"]
    return Environment(
        scenario,
        build(node["control"], ControlGains),
        build(node["drivers"], DriverProfile),
        build(node["corrections"], Corrections),
        None,
        flow,
    )


def configured(*overrides: str) -> Environment:
    """The environment of a flow."""
    return build(compose(["suite=paper", "flow=steady", *overrides])["environment"], Environment)


def drive(env: Environment, action: Action = Action.IDLE, seed: int = 10_000) -> Environment:
    """Drive a flow, all CAVs with one action."""
    world = env.reset(seed)
    while env.outcome is None:
        world = env.step({cav.id: action for cav in world.cavs})
    return env
