"""Drives the results that no bound may lie above; ``python tests/bound/bounded_results.py`` goes on where it stopped.

Methods in both worlds on seeds that no table uses. ``results.csv`` has the sum of arrivals of each success, and none
where a method did not succeed; ``bounds.csv`` has the bound of each scene, solved anew.
"""

import csv
from collections.abc import Iterator
from itertools import product
from pathlib import Path

from codriving.bound import bounded_world
from codriving.config import build, compose
from codriving.datatypes import Ending, Simulator
from codriving.experiment.objects import make_objects
from codriving.experiment.worker import Objects

RESULTS = Path(__file__).parent / "results.csv"

BOUNDS = RESULTS.with_name("bounds.csv")

SCENE = ("scenario", "suite", "cavs", "hdvs", "seed")

COLUMNS = (*SCENE, "method", "total")

METHODS = ("codriving", "fcfs", "idfst", "mcts", "coop_game")

FIRST = 26_000  # Seed of the first scene

# How many scenes there are for each number of CAVs without human drivers, and for four of them with some.
SCENES, AMONG_HUMANS = {4: 34, 8: 12, 12: 3}, 4


def cells() -> Iterator[tuple[str, str, int, bool, int]]:
    """Give scenario, suite, CAVs, whether there are human drivers, and number of scenes of each cell."""
    for suite, scenario in product(("default", "paper"), ("intersection", "roundabout")):
        for cavs, scenes in SCENES.items():
            yield scenario, suite, cavs, False, scenes
        yield scenario, suite, 4, True, AMONG_HUMANS


def overrides(scenario: str, suite: str, cavs: int, humans: bool) -> list[str]:
    """Return the overrides of a cell."""
    return [
        f"scenario={scenario}",
        f"suite={suite}",
        f"scenario.cavs={cavs}",
        *([] if humans else ["scenario.hdvs=[0,0]"]),
    ]


def driven(objects: Objects, seed: int) -> float | None:
    """Drive a scene and return the sum of arrivals [s]; None without success."""
    environment, method = objects.environment, objects.method
    world = environment.reset(seed)
    method.reset(environment.road_map, environment.driving_model, 0)
    while environment.outcome is None:
        world = environment.step(method.act(world).actions)
    outcome = environment.outcome
    return sum(outcome.arrivals.values()) if outcome.ending is Ending.SUCCESS else None


def record() -> None:
    """Drive what is missing, and add it to the file."""
    done = set()
    if RESULTS.exists():
        with RESULTS.open(encoding="utf-8", newline="") as file:
            done = {tuple(row.values())[:-1] for row in csv.DictReader(file)}
    else:
        RESULTS.write_text(",".join(COLUMNS) + "\n", encoding="utf-8")
    for scenario, suite, cavs, humans, scenes in cells():
        for method in METHODS:
            objects = None
            for seed in range(FIRST, FIRST + scenes):
                key = (scenario, suite, str(cavs), "some" if humans else "none", str(seed), method)
                if key in done:
                    continue
                if objects is None:
                    objects = make_objects(compose([*overrides(scenario, suite, cavs, humans), f"method={method}"]))
                found = driven(objects, seed)
                total = "" if found is None else f"{found:.1f}"
                with RESULTS.open("a", encoding="utf-8", newline="") as file:
                    csv.writer(file, lineterminator="\n").writerow((*key, total))


def bound() -> None:
    """Solve the bound of each scene of the results."""
    with RESULTS.open(encoding="utf-8", newline="") as file:
        scenes = dict.fromkeys(tuple(row[key] for key in SCENE) for row in csv.DictReader(file))
    worlds = {}
    with BOUNDS.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow((*SCENE, "bound"))
        for scenario, suite, cavs, hdvs, seed in sorted(scenes):
            cell = (scenario, suite, int(cavs), hdvs == "some")
            if cell not in worlds:
                worlds[cell] = bounded_world(build(compose(overrides(*cell))["environment"], Simulator))
            found = worlds[cell].solve(int(seed)).total
            writer.writerow((scenario, suite, cavs, hdvs, seed, f"{found:.1f}"))


if __name__ == "__main__":
    record()
    bound()
