"""Fits the coefficients of ``judgement=learned``: asks the world itself whether each driver lets the CAV pass.

An episode is driven by the rules. At moments drawn by the seed the world is copied, and in the copy the CAV goes on;
whether the driver then lets it pass is what is to be foretold.

    python docs/judgement/fit.py codriving/judgement/coefficients.json standoff:1000001:40 crowd:1000041:18

takes the file to write, and of each suite the first seed and the number of seeds.
"""

import json
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from codriving.exam.moments import judged_moments
from codriving.judgement.contests import FEATURES
from codriving.judgement.learned import fit

FIRST = 1_000_000  # Seeds below are for tuning and for tables
SHARE = 0.5  # Of the open pairs of each step, how many are asked about


def moments(suite: str, seed: int) -> list[tuple[dict[str, float], bool]]:
    """Drive one episode; return the numbers of some open pairs, and whether the driver lets the CAV pass."""
    if seed < FIRST:
        raise SystemExit(f"seeds of a training begin at {FIRST:,}, got {seed}")
    found = judged_moments(suite, [f"suite={suite}"], seed, SHARE)
    return [(dict(one.contest.numbers), one.yields) for one in found]


def main(file: Path, told: Sequence[str]) -> None:
    """Collect, see how well each eighth of the episodes is foretold by the others, fit and write."""
    parts = [(suite, int(first), int(count)) for suite, first, count in (text.split(":") for text in told)]
    each = [moments(suite, seed) for suite, first, count in parts for seed in range(first, first + count)]
    rows = np.array([[numbers[name] for name in FEATURES] for found in each for numbers, _ in found])
    truth = np.array([float(yields) for found in each for _, yields in found])
    fold = np.repeat(np.arange(len(each)), [len(found) for found in each]) % 8
    foretold = np.zeros(len(truth))
    for k in range(8):
        weights, bias = fit(rows[fold != k], truth[fold != k])
        foretold[fold == k] = 1 / (1 + np.exp(-(rows[fold == k] @ weights + bias)))
    weights, bias = fit(rows, truth)
    written = {
        "date": datetime.now(UTC).date().isoformat(),
        "seeds": {suite: f"{first} to {first + count - 1}" for suite, first, count in parts},
        "moments": len(truth),
        "let_pass": round(float(truth.mean()), 3),
        "accuracy_left_out": round(float(((foretold > 0.5) == truth).mean()), 3),
        "brier_left_out": round(float(((foretold - truth) ** 2).mean()), 3),
        "bias": round(bias, 6),
        "weights": {name: round(float(weight), 6) for name, weight in zip(FEATURES, weights, strict=True)},
    }
    file.write_text(json.dumps(written, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
