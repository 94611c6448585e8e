"""PPO: each CAV on its own, by a policy that one CAV has learned among human drivers (Schulman et al., 2017)."""

from codriving.methods.learned.learned import PROBABILITIES, Learned


class Ppo(Learned):
    """A policy of a single vehicle, on every CAV; others are strangers to it, as they were when it learned."""

    name = "ppo"
    shared, meaning = False, PROBABILITIES
