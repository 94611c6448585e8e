"""The world of 0.1 and the default one in one process: largest accelerations, and CPU time of a decision."""

import json
from time import thread_time

import numpy as np

from benchmarks.options import options
from codriving.config.compose import compose
from codriving.datatypes.record import Trajectory
from codriving.experiment.objects import make_objects

WORLDS = {"paper": "suite=paper", "default": "suite=default"}
SCENARIOS = ("intersection", "roundabout", "merge", "highway")
FIRST_SEED = 20_000  # Of the tuning seeds


def largest(trajectory: Trajectory) -> tuple[float, float, float]:
    """Return the hardest braking, acceleration and lateral acceleration of all vehicles [m/s2]."""
    braking = acceleration = lateral = 0.0
    for track in trajectory.tracks:
        braking = max(braking, -float(track.acceleration.min()))
        acceleration = max(acceleration, float(track.acceleration.max()))
        if len(track.heading) > 1:
            rate = np.abs(np.diff(np.unwrap(track.heading))) / trajectory.step
            lateral = max(lateral, float((rate * np.maximum(track.speed[:-1], track.speed[1:])).max()))
    return braking, acceleration, lateral


def main(arguments: list[str]) -> None:
    """Drive the same seeds in both worlds by turns, and print a row a scenario."""
    wanted = options(arguments, 20)
    for scenario in SCENARIOS:
        found: dict[str, list[tuple[float, float, float]]] = {world: [] for world in WORLDS}
        seconds: dict[str, list[float]] = {world: [] for world in WORLDS}
        made = {world: make_objects(compose([f"scenario={scenario}", suite])) for world, suite in WORLDS.items()}
        for seed in range(FIRST_SEED, FIRST_SEED + wanted.episodes):
            for world, objects in made.items():
                environment, method = objects.environment, objects.method
                state = environment.reset(seed)
                method.reset(environment.road_map, environment.driving_model, seed)
                while environment.outcome is None:
                    before = thread_time()
                    actions = method.act(state).actions
                    seconds[world].append(thread_time() - before)
                    state = environment.step(actions)
                found[world].append(largest(environment.trajectory()))
        for world in WORLDS:
            braking, acceleration, lateral = np.max(found[world], axis=0)
            row = {
                "scenario": scenario,
                "world": world,
                "braking": round(float(braking), 2),
                "acceleration": round(float(acceleration), 2),
                "lateral": round(float(lateral), 2),
                "decision_ms": round(1000 * float(np.mean(seconds[world])), 2),
            }
            print(json.dumps(row) if wanted.json else _line(row), flush=True)


def _line(row: dict[str, str | float]) -> str:
    limits = (
        f"braking {row['braking']:5.2f}, acceleration {row['acceleration']:5.2f}, lateral {row['lateral']:5.2f} m/s2"
    )
    return f"{row['scenario']:12} {row['world']:8} {limits}, CPU of a decision {row['decision_ms']:5.2f} ms"
