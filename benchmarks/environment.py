"""CPU time of an environment step against highway-env's own environment, which drives the same scene on the same road.

The physics are the same bit for bit on both sides: corrections and limits are off, and so is what ours adds to human
drivers. Each side is asked for what a method gets of it: ours for a world state, highway-env for its observation.
"""

import contextlib
from collections.abc import Iterator
from itertools import islice
from time import process_time

import numpy as np

from benchmarks.goals import Row, show
from benchmarks.options import options
from benchmarks.stock import Stock
from codriving.config.build import build
from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.datatypes.parts import Simulator
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment

RATES = {1: (10.0, 15), 5: (15.0, 15)}
"""Decisions a second: how many times faster than highway-env ours should be, and simulation steps a second."""
SECONDS = 8
NAMES = ("SLOWER", "IDLE", "FASTER")


def environment(scenario: str, rate: int, *, same: bool) -> Environment:
    """Build our environment: with highway-env's physics, or as it is by default."""
    _, frequency = RATES[rate]
    pace = (f"scenario.decision_frequency={rate}", f"scenario.simulation_frequency={frequency}")
    typed = [f"scenario={scenario}", *pace, *(["suite=paper"] if same else [])]
    node = compose(typed)["environment"]
    if same:
        node["corrections"] |= {name: False for name in node["corrections"] if name != "_target_"}
    made = build(node, Simulator, "environment", [])
    assert isinstance(made, Environment)
    return made


def spent(ours: Environment, stock: Stock, seed: int, rate: int) -> Iterator[tuple[float, float]]:
    """Step both by turns with the same actions.

    Yields:
        CPU time of a decision step of ours and of highway-env's [s].
    """
    rng = np.random.default_rng(seed)
    world = ours.reset(seed)
    stock.begin(seed)
    for _ in range(SECONDS * rate):
        if ours.outcome is not None:
            return
        known = [cav.id for cav in world.cavs]
        actions = {name: NAMES[int(rng.integers(len(NAMES)))] for name in known}
        possible = {name: Action(a if a in world.available[name] else "IDLE") for name, a in actions.items()}
        before = process_time()
        world = ours.step(possible)
        between = process_time()
        stock.decide({name: str(possible.get(name, "IDLE")) for name in stock.cavs})
        yield between - before, process_time() - between


def measure(episodes: int) -> Iterator[Row]:
    """Drive all scenarios at all rates, with the same physics and in the default world."""
    for scenario in choices("scenario"):
        for rate, (goal, _) in RATES.items():
            for world, same in (("same physics", True), ("default", False)):
                ours = environment(scenario, rate, same=same)
                stock = Stock(environment(scenario, rate, same=True))
                with contextlib.closing(stock):
                    # What is imported and worked out once belongs to neither.
                    list(islice(spent(ours, stock, 0, rate), 2))
                    pairs = [pair for seed in range(1, 1 + episodes) for pair in spent(ours, stock, seed, rate)]
                mine, theirs = (1e3 * sum(side) / len(pairs) for side in zip(*pairs, strict=True))
                yield Row(f"environment, {scenario} at {rate} Hz, {world}", mine, theirs, "ms", goal, least=True)


def main(arguments: list[str]) -> None:
    """Measure and print.

    Args:
        arguments: ``--episodes`` of each scenario and rate.
    """
    wanted = options(arguments, 3)
    rows = measure(wanted.episodes)
    show("environment", "highway-env", rows, as_json=wanted.json, store=wanted.store)
