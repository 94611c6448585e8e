"""With limits, too, CAVs do what prediction says, and no vehicle leaves what prediction calls its bounds."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from thorough import THOROUGH

from codriving.config.choices import choices
from codriving.datatypes.record import Track
from codriving.datatypes.world import Action, Kind, WorldState
from codriving.environment.environment import Environment
from codriving.reasoning.perception import states
from codriving.reasoning.prediction.forecast import Forecast, Reach
from codriving.reasoning.prediction.rollout import rollout

Build = Callable[..., Environment]


@pytest.fixture(scope="module")
def env(configured: Build, request: pytest.FixtureRequest) -> Environment:
    return configured("limits=road", *request.param)


def on_each(*drivers: str) -> pytest.MarkDecorator:
    """Each scenario, with each of some mixes of human drivers."""
    worlds = [(f"scenario={name}", f"drivers={mix}") for name in choices("scenario") for mix in drivers]
    return pytest.mark.parametrize("env", worlds, ids=" ".join, indirect=True)


def anything(world: WorldState, rng: np.random.Generator) -> dict[str, Action]:
    return {cav.id: world.available[cav.id][int(rng.integers(len(world.available[cav.id])))] for cav in world.cavs}


@on_each("simulator")
def test_speeds_are_those_of_the_forecast(env: Environment) -> None:
    model, rng, seen = env.driving_model, np.random.default_rng(0), set()
    forecast = Forecast(model, (), env.road_map)
    for seed in (1, 2, 3):
        world = env.reset(seed)
        while env.outcome is None and world.time < 16.0:
            actions = anything(world, rng)
            now = dict(zip([cav.id for cav in world.cavs], states(world, env.road_map, model), strict=True))
            first = round(world.time / model.step)
            world = env.step(actions)
            for track in env.trajectory().tracks:
                if track.id in now and track.kind is Kind.CAV:
                    speed, target, *where = now[track.id]
                    along = forecast.along(speed, (str(where[0]), float(where[1])))
                    _, speeds = rollout(model, [speed], [target], ((actions[track.id],),), model.substeps, along)
                    driven = track.speed[first : first + model.substeps + 1]
                    assert driven == pytest.approx(speeds[0, 0, : len(driven)], abs=1e-9)
                    seen.add(actions[track.id])
    assert seen >= {Action.SLOWER, Action.IDLE, Action.FASTER}


def bounded(env: Environment, seed: int) -> list[tuple[str, int, str, float, Reach]]:
    """Drive anyhow, and note of every vehicle what its bounds were at each decision."""
    rng, forecast = np.random.default_rng(seed), Forecast(env.driving_model, (), env.road_map)
    world, noted = env.reset(seed), []
    while env.outcome is None and world.time < 20.0:
        step = round(world.time / env.driving_model.step)
        forecast.begin_step(states(world, env.road_map, env.driving_model))
        for vehicle in env._traffic.vehicles:
            way = (vehicle.route_path.route.id, vehicle.s)
            reach = forecast.reach(float(vehicle.speed), vehicle.kind is Kind.CAV, way)
            noted.append((vehicle.id, step, *way, reach))
        world = env.step(anything(world, rng))
    return noted


def places(env: Environment, track: Track, step: int, route: str) -> np.ndarray:
    """Where a vehicle was on a route at each sample of a prediction, as long as it is near that route's centre line."""
    rows = slice(step, step + 101, 2)
    projected = env.road_map.paths[route].project_all(track.x[rows], track.y[rows])
    left = next((k for k, (_, side) in enumerate(projected) if abs(side) > 2.0), len(projected))
    return np.array([s for s, _ in projected[:left]])


@on_each("simulator", "rough")
@settings(max_examples=3 if THOROUGH else 1, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.integers(10_000, 15_000))
@example(seed=614)  # A CAV that changes lanes while it slows down almost to a stop
@example(seed=10_008)  # A CAV that cuts the corner, and is therefore earlier where it may drive faster
def test_no_vehicle_leaves_its_bounds(env: Environment, seed: int) -> None:
    noted = bounded(env, seed)
    tracks = {track.id: track for track in env.trajectory().tracks}
    for name, step, route, place, reach in noted:
        driven = places(env, tracks[name], step, route) - place
        assert (reach.least[: len(driven)] <= driven + 1e-9).all(), (name, step)
        assert (driven <= reach.most[: len(driven)] + 1e-9).all(), (name, step)
