"""CPU time of a decision step: our environment against highway-env's own intersection, with as many vehicles."""

import json
from time import process_time

import numpy as np
from highway_env.envs.intersection_env import IntersectionEnv

from benchmarks.options import options
from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment

SEEDS = (0, 1, 2)
ROUNDS = 4
DECISIONS = 8
CAVS, HDVS = 4, 3


class Ours:
    """Our environment with highway-env's own human drivers and without limits, everything corrected."""

    def __init__(self) -> None:
        config = compose(["suite=paper", f"scenario.cavs={CAVS}", f"scenario.hdvs=[{HDVS},{HDVS}]"])
        made = build(config["environment"], object, "environment")
        assert isinstance(made, Environment)
        self.environment = made

    def reset(self, seed: int) -> None:
        """Begin the episode of a seed."""
        self.world = self.environment.reset(seed)

    def step(self, rng: np.random.Generator) -> int:
        """Take one decision; return the number of vehicles that were driven."""
        if self.environment.outcome is not None:
            return 0
        actions = {cav.id: (Action.SLOWER, Action.IDLE)[int(rng.integers(2))] for cav in self.world.cavs}
        vehicles = len(self.world.vehicles)
        self.world = self.environment.step(actions)
        return vehicles


class Stock:
    """highway-env's intersection with several agents, at the same frequencies; no vehicle is added on the way."""

    def __init__(self) -> None:
        agents = {"type": "MultiAgentAction", "action_config": {"type": "DiscreteMetaAction", "lateral": False}}
        agents["action_config"] |= {"longitudinal": True, "target_speeds": [0, 3, 6, 9]}  # type: ignore[operator]
        self.environment = IntersectionEnv(
            config={
                "action": agents,
                "controlled_vehicles": CAVS,
                "initial_vehicle_count": HDVS,
                "spawn_probability": 0.0,
                "simulation_frequency": 10,
                "policy_frequency": 2,
                "duration": 1000,
            }
        )

    def reset(self, seed: int) -> None:
        """Begin the episode of a seed, then take away vehicles to even out their number; none is added."""
        self.environment.reset(seed=seed)
        road = self.environment.road
        surplus = len(road.vehicles) - CAVS - HDVS
        others = [v for v in road.vehicles if v not in self.environment.controlled_vehicles]
        for vehicle in others[: max(surplus, 0)]:
            road.vehicles.remove(vehicle)

    def step(self, rng: np.random.Generator) -> int:
        """Take one decision; return the number of vehicles that were driven."""
        vehicles = len(self.environment.road.vehicles)
        self.environment.step(tuple(int(a) for a in rng.integers(0, 2, size=CAVS)))
        return vehicles


def measure(rounds: int = ROUNDS) -> dict[str, float]:
    """Step both alternately.

    Args:
        rounds: Rounds over the same seeds; the fastest one of each side counts, so the first may warm caches up.

    Returns:
        CPU time a decision and a vehicle [ms], and the ratio of the two.
    """
    sides: dict[str, Ours | Stock] = {"ours": Ours(), "stock": Stock()}
    best = dict.fromkeys(sides, np.inf)
    for _ in range(rounds):
        spent = dict.fromkeys(sides, 0.0)
        driven = dict.fromkeys(sides, 0)
        for seed in SEEDS:
            rngs = {name: np.random.default_rng(seed) for name in sides}
            for side in sides.values():
                side.reset(seed)
            for _ in range(DECISIONS):
                for name, side in sides.items():
                    before = process_time()
                    driven[name] += side.step(rngs[name])
                    spent[name] += process_time() - before
        for name in sides:
            best[name] = min(best[name], 1e3 * spent[name] / driven[name])
    vehicles = CAVS + HDVS
    return {
        "vehicles": vehicles,
        "ours_ms": round(best["ours"] * vehicles, 3),
        "stock_ms": round(best["stock"] * vehicles, 3),
        "ratio": round(best["stock"] / best["ours"], 1),
    }


def main(arguments: list[str]) -> None:
    """Measure and print.

    Args:
        arguments: ``--json`` prints JSON instead of a table.
    """
    wanted = options(arguments)
    found = measure()
    if wanted.json:
        print(json.dumps({"environment": found}))
        return
    print(f"environment: CPU time of a decision step with {found['vehicles']} vehicles, 5 simulation steps [ms]")
    print(f"  ours, corrected            {found['ours_ms']:8.2f}")
    print(f"  highway-env's intersection {found['stock_ms']:8.2f}   {found['ratio']:.1f} times ours")
