"""MAPPO for four CAVs that share one policy, with BenchMARL, on what `madqn` observes: python train.py FOLDER.

Trains at junctions of the default world with human drivers of drivers=mixed, a third of the episodes standoffs, and
prints every ten updates in which share of the validation episodes all CAVs got through.
"""

import argparse
import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import torch
from benchmarl.algorithms import MappoConfig
from benchmarl.environments.pettingzoo.common import PettingZooClass
from benchmarl.experiment import Callback, Experiment, ExperimentConfig
from benchmarl.models.mlp import MlpConfig
from gymnasium.spaces import Box, Discrete
from pettingzoo import ParallelEnv
from tensordict import TensorDict
from torchrl.envs import PettingZooWrapper
from torchrl.envs.utils import ExplorationType, set_exploration_type

import codriving
from codriving.gym import ACTIONS as NUMBERS
from codriving.methods import ACTIONS, Features, allowed, feature_count

FAMILY = "junction"
COUNT = len(ACTIONS[FAMILY])
REWARD = {"arrival": 1.0, "collision": -3.0, "time": -0.025, "speed": 0.0375}  # As of madqn
STANDOFF = {"pattern": "standoff", "turns": ["left", "straight"], "start": [20.0, 70.0]}
Kind = tuple[str, dict[str, Any]]
TRAFFIC: list[Kind] = [
    ("intersection", {"hdvs": [0, 4], "cav_speed": [3.0, 9.0], "hdv_speed": [5.0, 9.0]}),
    ("intersection", {"hdvs": [0, 4], "cav_speed": [5.0, 9.0], "hdv_speed": [5.0, 9.0], **STANDOFF}),
    ("roundabout", {"hdvs": [0, 4], "cav_speed": [3.0, 9.0], "hdv_speed": [5.0, 9.0]}),
]
EXAMS: dict[str, Kind] = {
    "intersection_4_3": ("intersection", {"hdvs": [3, 3]}),
    "roundabout_4_3": ("roundabout", {"hdvs": [2, 4]}),
    "standoff_4_3": ("intersection", {"hdvs": [2, 4], "cav_speed": [8.0, 8.0], **STANDOFF}),
}


class Cavs(ParallelEnv):
    """Four CAVs in one of several kinds of traffic, drawn for each episode from seeds of 1,000,000 and more."""

    metadata = {"name": "cavs", "render_modes": []}
    render_mode = None

    def __init__(self, kinds: Iterable[Kind], seed: int = 0) -> None:
        self.envs = [
            codriving.parallel_env(name, "drivers=mixed", rows=1, reward=REWARD, cavs=4, **settings)
            for name, settings in kinds
        ]
        self.features = [
            Features(env.environment.road_map, env.environment.driving_model, FAMILY, shared=True) for env in self.envs
        ]
        self.possible_agents, self.kind, self.rng = self.envs[0].possible_agents, 0, np.random.default_rng(seed + 7)

    @property
    def agents(self):
        return self.envs[self.kind].agents

    def observation_space(self, agent):
        return Box(-10, 10, (feature_count(FAMILY),), np.float32)

    def action_space(self, agent):
        return Discrete(COUNT)

    def reset(self, seed=None, options=None):
        self.kind = int(self.rng.integers(len(self.envs)))
        drawn = int(self.rng.integers(1_000_000, 2**31))
        self.envs[self.kind].reset(seed=options["seed"] if options else drawn)
        self.features[self.kind].reset()
        return self.look(self.possible_agents)

    def step(self, actions):
        before = self.agents
        numbers = {agent: NUMBERS.index(ACTIONS[FAMILY][int(actions[agent])]) for agent in before}
        _, *turn, _ = self.envs[self.kind].step(numbers)
        seen, infos = self.look(before)
        return seen, *({agent: of[agent] for agent in before} for of in turn), infos

    def look(self, agents):
        """What each observes and may do; zeros for one that has arrived."""
        world = self.envs[self.kind].world
        found = self.features[self.kind].observe(world)
        nothing, all_actions = np.zeros(feature_count(FAMILY), np.float32), np.ones(COUNT, bool)
        seen = {agent: np.asarray(found.get(agent, nothing), np.float32) for agent in agents}
        masks = {a: np.asarray(allowed(FAMILY, world.available[a])) if a in found else all_actions for a in agents}
        return seen, {agent: {"action_mask": mask} for agent, mask in masks.items()}


class Junctions(PettingZooClass):
    """The task, as BenchMARL asks for it."""

    def get_env_fun(self, num_envs, continuous_actions, seed, device):
        seeds = iter(range(seed * 100, seed * 100 + 100))

        def made() -> PettingZooWrapper:
            cavs = Cavs(TRAFFIC, next(seeds))
            return PettingZooWrapper(cavs, use_mask=True, group_map={"cavs": cavs.possible_agents}, device=device)

        return made

    def supports_continuous_actions(self):
        return False

    def supports_discrete_actions(self):
        return True

    def has_state(self):
        return False

    def max_steps(self, env):
        return 120

    @staticmethod
    def env_name():
        return "codriving"


def examine(policy: Callable[[TensorDict], TensorDict], first_seed: int, episodes: int) -> dict[str, float]:
    """Drive the validation episodes by the likeliest actions; gives the share that all CAVs got through."""
    shares = {}
    for name, kind in EXAMS.items():
        env, passed = Cavs([kind]), 0
        for seed in range(first_seed, first_seed + episodes):
            env.reset(options={"seed": seed})
            while env.agents:
                seen, infos = env.look(env.possible_agents)
                observed = {
                    "observation": torch.tensor(np.stack(list(seen.values()))),
                    "action_mask": torch.tensor(np.stack([info["action_mask"] for info in infos.values()])),
                }
                with torch.no_grad(), set_exploration_type(ExplorationType.DETERMINISTIC):
                    chosen = policy(TensorDict({"cavs": TensorDict(observed, [4])}, []))["cavs", "action"]
                env.step({agent: int(k) for agent, k in zip(env.possible_agents, chosen, strict=True)})
            passed += env.envs[0].environment.outcome.ending.name == "SUCCESS"
        shares[name] = passed / episodes
    return shares


class Curve(Callback):
    """Prints a line of the curve every ten updates."""

    def on_train_end(self, training_td, group):
        done = self.experiment.n_iters_performed + 1
        if done % 10 == 0:
            shares = examine(self.experiment.policy, 20_000, 20)
            print(json.dumps({"decisions": done * 2048 * 4, **shares}), flush=True)


def main() -> None:
    """Train, validate and keep the policy."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--updates", type=int, default=80, help="each after 2,048 decisions of each CAV")
    chosen = parser.parse_args()
    chosen.folder.mkdir(parents=True, exist_ok=True)
    torch.set_num_threads(1)
    config = ExperimentConfig.get_from_yaml()
    config.max_n_iters, config.max_n_frames, config.loggers, config.create_json = chosen.updates, None, [], False
    config.evaluation = config.render = False
    config.on_policy_collected_frames_per_batch, config.on_policy_n_envs_per_worker = 2048, 8
    config.on_policy_minibatch_size, config.on_policy_n_minibatch_iters = 256, 8
    config.gamma, config.lr, config.share_policy_params = 0.97, 3e-4, True
    config.clip_grad_norm, config.clip_grad_val = True, 0.5
    config.save_folder = str(chosen.folder)
    algorithm = MappoConfig.get_from_yaml()
    algorithm.lmbda, algorithm.entropy_coef, algorithm.clip_epsilon = 0.95, 0.01, 0.2
    actor, critic = MlpConfig.get_from_yaml(), MlpConfig.get_from_yaml()
    actor.num_cells, critic.num_cells = [128, 128], [256, 256]
    experiment = Experiment(Junctions("JUNCTIONS", {}), algorithm, actor, 1, config, critic, callbacks=[Curve()])
    experiment.run()
    print(json.dumps({"on other seeds": examine(experiment.policy, 25_000, 60)}))
    torch.save(experiment.policy.state_dict(), chosen.folder / "policy.pt")


if __name__ == "__main__":
    main()
