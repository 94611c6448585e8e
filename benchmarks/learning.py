"""CPU time of a decision step as an environment for learning, against the bare environment on the same episodes."""

import json
from time import process_time

import gymnasium
import numpy as np

import codriving
from benchmarks.options import options
from codriving.config.choices import choices
from codriving.gym.actions import ACTIONS

SEEDS = (0, 1, 2)
ROUNDS = 3
DECISIONS = 10
ENVIRONMENTS = 8
GOAL = 2_000
"""Joint decisions a second and core, at the intersection."""


def measure(name: str, rounds: int = ROUNDS) -> dict[str, float]:
    """Step both alternately with the same actions.

    Args:
        name: Name of the scenario.
        rounds: Rounds over the same seeds; the fastest one of each side counts.

    Returns:
        CPU time a decision step [ms] of the bare environment and of the PettingZoo face, and the latter's share.
    """
    face, bare = codriving.parallel_env(name), codriving.parallel_env(name).environment
    best = {"bare": np.inf, "face": np.inf}
    for _ in range(rounds):
        spent, steps = dict.fromkeys(best, 0.0), 0
        for seed in SEEDS:
            rng = np.random.default_rng(seed)
            face.reset(seed=seed)
            bare.reset(seed)
            for _ in range(DECISIONS):
                if not face.agents:
                    break
                numbers = {agent: int(rng.integers(2)) for agent in face.agents}
                actions = {agent: ACTIONS[number] for agent, number in numbers.items()}
                before = process_time()
                bare.step(actions)
                between = process_time()
                face.step(numbers)
                spent["bare"] += between - before
                spent["face"] += process_time() - between
                steps += 1
        best = {side: min(best[side], 1e3 * spent[side] / steps) for side in best}
    share = 1 - best["bare"] / best["face"]
    return {"bare_ms": round(best["bare"], 3), "face_ms": round(best["face"], 3), "share": round(share, 3)}


def vectorised(name: str, rounds: int = ROUNDS) -> float:
    """Return joint decisions a second of CPU time, of several environments made by ``gymnasium.make_vec``."""
    made = gymnasium.make_vec(f"codriving.gym:codriving/{name}-v1", num_envs=ENVIRONMENTS, vectorization_mode="sync")
    rng, cavs, best = np.random.default_rng(0), made.single_observation_space.shape[0], 0.0  # type: ignore[index]
    for _ in range(rounds):
        made.reset(seed=list(range(ENVIRONMENTS)))
        before = process_time()
        for _ in range(DECISIONS):
            made.step(rng.integers(2, size=(ENVIRONMENTS, cavs)))
        best = max(best, ENVIRONMENTS * DECISIONS / (process_time() - before))
    made.close()
    return round(best)


def main(arguments: list[str]) -> None:
    """Measure and print.

    Args:
        arguments: ``--json`` prints JSON instead of a table.
    """
    wanted = options(arguments)
    found = {name: {**measure(name), "vectorised": vectorised(name)} for name in choices("scenario")}
    if wanted.json:
        print(json.dumps({"learning": found}))
        return
    print("learning: CPU time of a decision step [ms], and what observations, rewards and masks add to it")
    for name, one in found.items():
        print(f"  {name:14}{one['bare_ms']:8.2f} bare{one['face_ms']:8.2f} with PettingZoo{one['share']:8.0%}")
    print(f"learning: joint decisions a second and core (goal {GOAL} at the intersection)")
    for name, one in found.items():
        print(f"  {name:14}{1e3 / one['face_ms']:8.0f} with PettingZoo{one['vectorised']:8.0f} with make_vec")
