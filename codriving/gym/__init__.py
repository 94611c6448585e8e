"""The environment for learners: PettingZoo with one agent a CAV, Gymnasium with one agent for all CAVs or for one.

Importing this room registers every scenario with Gymnasium.
"""

from codriving.gym.actions import ACTIONS, draw_seed
from codriving.gym.observation import Observer
from codriving.gym.parallel import ParallelDriving
from codriving.gym.registration import register_scenarios
from codriving.gym.reward import RewardWeights, reward_weights
from codriving.gym.single import ObserverFactory, SingleDriving

__all__ = [
    "ACTIONS", "Observer", "ObserverFactory", "ParallelDriving", "RewardWeights", "SingleDriving", "draw_seed",
    "reward_weights",
]  # fmt: skip

register_scenarios()
