"""Answers the question of docs/tutorial.md from a run folder: prints how it came out and draws the figure.

Run it from the top level of the repository, in an environment that has codriving:

    python docs/images/rough_drivers.py outputs/run/rough-drivers docs/images/rough-drivers.svg
"""

import sys
from pathlib import Path

import matplotlib
import pandas as pd

from codriving.metrics import mcnemar, mean_interval, wilson_interval

METHODS = {"codriving": ("#0072b2", "o"), "fcfs": ("#d55e00", "s")}
DRIVERS = ("attentive", "rough")


def clean_by_seed(folder: Path) -> pd.DataFrame:
    """Give clean success (1 or 0) with a row a seed, and a column a method and kind of drivers."""
    episodes = pd.read_csv(folder / "episodes.csv")
    clean = episodes.pivot(index="seed", columns=["method", "drivers"], values="clean")
    return clean.dropna()  # A seed with an error in any of the four is left out of all.


def say(clean: pd.DataFrame) -> None:
    """Print what rough drivers cost each method on the same seeds, and by how much more they cost FCFS."""
    costs = {}
    for method in METHODS:
        attentive, rough = (clean[method, drivers] for drivers in DRIVERS)
        costs[method] = attentive - rough
        lost, gained = int((costs[method] > 0).sum()), int((costs[method] < 0).sum())
        print(
            f"{method}: {attentive.mean():.0%} clean with attentive drivers, {rough.mean():.0%} with rough ones; "
            f"of {len(clean)} seeds {lost} lost and {gained} gained, p = {mcnemar(lost, gained):.2g}"
        )
    more = 100 * (costs["fcfs"] - costs["codriving"])
    low, high = mean_interval(list(more)) or (float("nan"), float("nan"))
    print(f"rough drivers cost fcfs {more.mean():+.0f} points more than codriving (95 %: {low:+.0f} to {high:+.0f})")


def draw(clean: pd.DataFrame, target: Path) -> None:
    """Draw clean success of both methods with both kinds of drivers, with Wilson 95 % intervals."""
    matplotlib.use("Agg")
    from matplotlib import pyplot

    matplotlib.rcParams["svg.hashsalt"] = "rough drivers"  # The same numbers give the same file.
    figure, axes = pyplot.subplots(figsize=(5.2, 3.4), layout="constrained")
    for shift, (method, (colour, mark)) in zip((-0.06, 0.06), METHODS.items(), strict=True):
        rates = [100 * clean[method, drivers].mean() for drivers in DRIVERS]
        limits = [wilson_interval(int(clean[method, drivers].sum()), len(clean)) for drivers in DRIVERS]
        below = [rate - 100 * low for rate, (low, _) in zip(rates, limits, strict=True)]
        above = [100 * high - rate for rate, (_, high) in zip(rates, limits, strict=True)]
        places = [k + shift for k in range(len(DRIVERS))]
        axes.errorbar(places, rates, yerr=[below, above], color=colour, marker=mark, capsize=4, label=method)
    axes.set(xlim=(-0.4, 1.4), ylim=(0, 100), ylabel=f"clean success [%], {len(clean)} seeds, 95 % intervals")
    axes.set_xticks(range(len(DRIVERS)), [f"drivers={drivers}" for drivers in DRIVERS])
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, loc="lower left")
    figure.savefig(target, metadata={"Date": None, "Creator": None} if target.suffix == ".svg" else None)


if __name__ == "__main__":
    found = clean_by_seed(Path(sys.argv[1]))
    say(found)
    draw(found, Path(sys.argv[2]))
