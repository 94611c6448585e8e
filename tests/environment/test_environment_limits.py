"""What a car can do: no vehicle accelerates, brakes or turns harder, and each limit is reached where it is asked."""

import os
from collections.abc import Callable

import numpy as np
import pytest

from codriving.datatypes.limits import VehicleLimits
from codriving.datatypes.road import Arc, Lane, Road, Route, Straight, Turn
from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.environment import Environment

Build = Callable[..., Environment]

SEEDS = int(os.environ.get("SEEDS", "2"))
"""How many seeds of each scenario are driven; ``make check-all`` drives 20."""

ROAD = {"acceleration": 4.0, "braking": 8.0, "lateral": 4.0, "comfort_lateral": 3.0, "comfort_braking": 2.4}

TWO_LANES = Road(
    "two lanes",
    tuple(Lane(("a", "b", k), Straight((0.0, 4.0 * k), (900.0, 4.0 * k)), speed_limit=30.0) for k in (0, 1)),
    tuple(Route(f"lane-{k}", (("a", "b", k),), Turn.STRAIGHT, entry=800.0, goal=880.0) for k in (0, 1)),
)

BEND = Road(
    "bend",
    (
        Lane(("a", "b", 0), Straight((0.0, 0.0), (150.0, 0.0)), speed_limit=20.0),
        Lane(("b", "c", 0), Arc((150.0, 12.0), 12.0, -np.pi / 2, 0.0, True), speed_limit=20.0),
        Lane(("c", "d", 0), Straight((162.0, 12.0), (162.0, 90.0)), speed_limit=20.0),
    ),
    (Route("round", (("a", "b", 0), ("b", "c", 0), ("c", "d", 0)), Turn.RIGHT, entry=150.0, goal=230.0),),
)


def hardest(env: Environment) -> tuple[float, float, float]:
    """The largest braking, acceleration and lateral acceleration of any vehicle."""
    pedals, sideways = [0.0], [0.0]
    for track in env.trajectory().tracks:
        pedals += track.acceleration.tolist()
        rate = np.abs(np.diff(np.unwrap(track.heading))) / 0.1
        sideways += (rate * np.maximum(track.speed[:-1], track.speed[1:])).tolist()
    return -min(pedals), max(pedals), max(sideways)


@pytest.mark.parametrize("name", ["intersection", "roundabout", "highway", "merge"])
def test_no_vehicle_is_over_a_limit(configured: Build, name: str) -> None:
    env = configured(f"scenario={name}", "limits=road")
    rng = np.random.default_rng(7)
    for seed in range(10_000, 10_000 + SEEDS):
        world = env.reset(seed)
        while env.outcome is None and world.time < 20.0:
            actions = {cav.id: rng.choice(list(world.available[cav.id])) for cav in world.cavs}
            world = env.step({name: Action(action) for name, action in actions.items()})
        braking, pedal, sideways = hardest(env)
        assert braking <= 8.0
        assert pedal <= 4.0
        assert sideways <= 4.0 + 1e-9
    assert max(braking, pedal, sideways) > 2.5


def test_without_limits_vehicles_are_over_them(configured: Build) -> None:
    env = configured("scenario=highway", "limits=none")
    world = env.reset(10_000)
    while env.outcome is None and world.time < 8.0:
        world = env.step({cav.id: world.available[cav.id][-1] for cav in world.cavs})
    assert hardest(env)[2] > 15.0


def driven(env: Environment, *actions: Action) -> Environment:
    env.reset(0)
    for action in actions:
        env.step({"CAV1": action})
    return env


@pytest.mark.parametrize(
    ("speed", "action", "pedal"), [(0.0, Action.FASTER, 4.0), (28.0, Action.SLOWER, -8.0), (28.0, Action.FASTER, 3.2)]
)
def test_a_pedal_goes_to_its_limit_and_no_farther(limited: Build, speed: float, action: Action, pedal: float) -> None:
    speeds = (0.0, 10.0, 20.0, 30.0)
    env = driven(limited(TWO_LANES, speed, target_speeds=speeds), action)
    assert env.trajectory().tracks[0].acceleration[1] == pytest.approx(pedal)


@pytest.fixture
def limited(by_hand: Build) -> Build:
    """Builds an environment with limits and one CAV, or another vehicle, on the first route of a road."""

    def build(road: Road, speed: float, place: float = 20.0, kind: Kind = Kind.CAV, **settings: object) -> Environment:
        others = [Start("CAV1", Kind.CAV, road.routes[0].id, 0.0, 0.0)] if kind is Kind.HDV else []
        starts = [*others, Start(f"{kind}1", kind, road.routes[0].id, place, speed)]
        return by_hand(starts=starts, road=road, limits=VehicleLimits(**ROAD), **settings)

    return build


@pytest.mark.parametrize("speed", [8.0, 15.0, 30.0])
def test_a_lane_change_can_be_driven(limited: Build, speed: float) -> None:
    speeds = (0.0, 10.0, 20.0, 30.0)
    env = driven(limited(TWO_LANES, speed, target_speeds=speeds), Action.LANE_RIGHT, *[Action.IDLE] * 11)
    track = env.trajectory().tracks[0]
    assert hardest(env)[2] == pytest.approx(3.0, abs=0.15)
    # The centre is 1 m from the new lane's, so that the body, 2 m wide, has left the old one.
    left = np.flatnonzero(track.y > 3.0)[0] * 0.1
    assert 2.8 <= left <= 3.4
    assert track.y[-1] == pytest.approx(4.0, abs=0.1)
    assert track.y.max() < 4.1


def test_a_lane_change_is_over_when_it_should_be() -> None:
    limits = VehicleLimits(**ROAD)
    # K_h K_l w = 3 and K_h = 4 K_l; (1 + x) exp(-x) = 1/4 at x = 2.693, and the rate is K_h / 2 = 0.866.
    assert limits.change_gains(4.0) == pytest.approx((1.7321, 0.4330), abs=1e-4)
    assert limits.clears_after(4.0) == pytest.approx(3.109, abs=2e-3)


@pytest.mark.parametrize("kind", [Kind.CAV, Kind.HDV])
def test_a_bend_is_driven_in_comfort(limited: Build, kind: Kind) -> None:
    speeds = (0.0, 5.0, 10.0, 15.0)
    env = limited(BEND, 15.0, place=60.0, kind=kind, target_speeds=speeds)
    world = env.reset(0)
    while world.time < 19.0 and env.outcome is None:
        world = env.step(dict.fromkeys(world.available, Action.IDLE))
    track = next(track for track in env.trajectory().tracks if track.kind is kind and track.speed[0] == 15.0)
    # sqrt(3 m/s2 * 12 m) = 6 m/s on the arc, which ends 169 m from the start; it begins at 150 m.
    on_the_arc = (track.x > 151.0) & (track.y < 11.0)
    assert on_the_arc.sum() > 20
    assert track.speed[on_the_arc].max() <= 6.0 + 0.02
    assert track.speed[on_the_arc].min() > 5.0
    assert -2.9 < track.acceleration[track.x < 150.0].min() < -2.0


def test_the_tyres_hold_a_vehicle_that_is_too_fast(limited: Build) -> None:
    env = driven(limited(BEND, 12.0, place=148.0), *[Action.IDLE] * 3)
    assert hardest(env)[2] == pytest.approx(4.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"braking": 20.0}, "braking must be 3 to 12 m/s2, got 20"),
        ({"comfort_lateral": 5.0}, "comfort_lateral must be at most lateral .4 m/s2., got 5 m/s2"),
        ({"comfort_braking": 9.0}, "comfort_braking must be at most braking .8 m/s2., got 9 m/s2"),
    ],
)
def test_limits_out_of_range_are_refused(change: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        VehicleLimits(**{**ROAD, **change})
