"""Our environment for others: PettingZoo for several agents, Gymnasium for one that drives all CAVs."""
