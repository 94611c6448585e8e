"""MADQN: all CAVs share one trained network, and each acts on what it observes (Egorov, 2016; see docs/methods)."""

from codriving.methods.learned.learned import VALUES, Learned


class Madqn(Learned):
    """Parameter-shared Double DQN: CAVs tell one another where they are and what they mean to do."""

    name = "madqn"
    shared, meaning = True, VALUES
