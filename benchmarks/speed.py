"""CPU time of a decision against another checkout: ``--only speed --against CHECKOUT``.

A decision is one step of all CAVs. The sides drive the same seeds by turns, episode by episode.
"""

from collections.abc import Iterator
from contextlib import ExitStack
from itertools import chain
from pathlib import Path
from statistics import median

from benchmarks.goals import Row, show
from benchmarks.options import options
from benchmarks.side import THIS, Side

SCENES = {
    "intersection": ("scenario=intersection",),
    "intersection, 8 CAVs": ("scenario=intersection", "scenario.cavs=8"),
    "intersection, 12 CAVs": ("scenario=intersection", "scenario.cavs=12"),
    "roundabout": ("scenario=roundabout",),
    "merge": ("scenario=merge",),
    "highway": ("scenario=highway",),
}
WORLDS = {"paper": 0.5, "default": 1.0}
"""The suite that this version drives in, and its goal; the other side always drives in its own default world."""
FIRST_SEED = 20_000  # Of the tuning seeds
STARTS, START_EPISODES, SLOWEST = 3, 1, 0.25


def decisions(other: Path, scene: str, episodes: int) -> Iterator[Row]:
    """Drive a scene; what is done once a road is spread over the episodes."""
    spent, steps = dict.fromkeys(("other", *WORLDS), 0.0), dict.fromkeys(("other", *WORLDS), 0)
    with ExitStack() as stack:
        sides = {"other": stack.enter_context(Side(other, SCENES[scene]))}
        sides |= {world: stack.enter_context(Side(THIS, [*SCENES[scene], f"suite={world}"])) for world in WORLDS}
        for seed in range(FIRST_SEED, FIRST_SEED + episodes):
            for name, side in sides.items():
                taken = side.drive(seed)["decisions"]
                spent[name] += sum(taken)
                steps[name] += len(taken)
    mean = {name: 1e3 * spent[name] / steps[name] for name in spent}
    for world, goal in WORLDS.items():
        yield Row(f"decision, {scene}, {world}", mean[world], mean["other"], "ms", goal)


def slowest(other: Path, scene: str) -> Iterator[Row]:
    """Begin anew in fresh processes, by turns: the median of the slowest decisions of each."""
    found: dict[str, list[float]] = {name: [] for name in ("other", *WORLDS)}
    for start in range(STARTS):
        for name, of in found.items():
            suite = [] if name == "other" else [f"suite={name}"]
            with Side(other if name == "other" else THIS, [*SCENES[scene], *suite]) as side:
                first = FIRST_SEED + start * START_EPISODES
                of.append(max(max(side.drive(seed)["decisions"]) for seed in range(first, first + START_EPISODES)))
    middle = {name: 1e3 * median(of) for name, of in found.items()}
    for world in WORLDS:
        yield Row(f"slowest decision, {scene}, {world}", middle[world], middle["other"], "ms", SLOWEST)


def main(arguments: list[str]) -> None:
    """Measure and print.

    Args:
        arguments: ``--against CHECKOUT``, without which nothing is measured; ``--episodes`` of each scene.
    """
    wanted = options(arguments, 8)
    if wanted.against is None:
        print("speed: not measured; --against CHECKOUT names a checkout of the version to compare with")
        return
    lone = [scene for scene in SCENES if "CAVs" not in scene]
    rows = chain(
        *(decisions(wanted.against, scene, wanted.episodes) for scene in SCENES),
        *(slowest(wanted.against, scene) for scene in lone),
    )
    show("speed", wanted.against.name, rows, as_json=wanted.json, store=wanted.store)
