"""Frames a second of a replay: drawing alone (CPU) and the whole film (wall clock), for every scenario."""

import json
import tempfile
from fractions import Fraction
from pathlib import Path
from time import perf_counter, process_time

import codriving
from benchmarks.options import options
from codriving.config.choices import choices
from codriving.experiment.stored import find_episode, read_film, road_of

RATE, SECONDS = Fraction(25), 10
SCALES = (1.0, 2.0)


def measure(scenario: str, folder: Path) -> dict[str, float]:
    """Drive one short episode and film it.

    Args:
        scenario: Name of the scenario.
        folder: Where to drive and to write.

    Returns:
        Frames a second of drawing and of the whole, and the size of the film [MB], for each scale.
    """
    tokens = [f"scenario={scenario}", "episodes=1", f"scenario.time_limit={SECONDS}", "launcher=serial"]
    results = codriving.run(*tokens, f"output={folder}", f"run={scenario}")
    found: dict[str, float] = {}
    episode = find_episode(results.folder, None, None)
    for scale in SCALES:
        show = read_film(episode.folder, road_of(episode.cell), scale)
        show.frame(0.0)
        count, before = 0, process_time()
        for _ in show.frames(RATE, 1.0):
            count += 1
        found[f"drawn_{scale:g}x"] = round(count / (process_time() - before), 1)
        film = folder / "film.mp4"
        before = perf_counter()
        show.write(film, "mp4", RATE, 1.0)
        found[f"filmed_{scale:g}x"] = round(count / (perf_counter() - before), 1)
        found[f"mb_{scale:g}x"] = round(film.stat().st_size / 1e6, 2)
    return found


def main(arguments: list[str]) -> None:
    """Measure and print.

    Args:
        arguments: ``--json`` prints JSON instead of a table.
    """
    wanted = options(arguments)
    with tempfile.TemporaryDirectory() as folder:
        found = {name: measure(name, Path(folder)) for name in choices("scenario")}
    if wanted.json:
        print(json.dumps({"pictures": found}))
        return
    print(f"pictures: frames a second of a film of {SECONDS} s at 1280 x 720, and at twice that")
    for name, row in found.items():
        drawn, filmed = (" / ".join(f"{row[f'{what}_{s:g}x']:.0f}" for s in SCALES) for what in ("drawn", "filmed"))
        print(f"  {name:<14} drawn {drawn:>10}   filmed {filmed:>10}   {row['mb_1x']:.1f} / {row['mb_2x']:.1f} MB")
