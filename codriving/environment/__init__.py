"""Scenario to world state to step: the paper's environment module, and the only door to highway-env."""
