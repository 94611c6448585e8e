"""Our environment for learners: PettingZoo with one agent a CAV, Gymnasium with one agent for all CAVs.

Importing this room registers every scenario with Gymnasium.
"""

from codriving.gym.registration import register_scenarios

register_scenarios()
