"""A judge that was fitted: logistic regression on the numbers of each pair."""

import json
from collections.abc import Mapping, Sequence
from math import exp
from pathlib import Path

import numpy as np

from codriving.datatypes import Judgement, Judgements
from codriving.errors import ConfigError, require
from codriving.geometry import Array
from codriving.judgement.contests import FEATURES, Contest
from codriving.judgement.judge import Judge, said, thresholds

OURS = Path(__file__).with_name("coefficients.json")

RIDGE = 10.0  # Weight of the squares of the standardised coefficients, in moments

ROUNDS = 50  # Newton's steps at most; a dozen do


class FittedJudge(Judge):
    """Adds the numbers up with weights that were fitted, see ``docs/judgement/fit.py``.

    Args:
        file: A file of ``fit``; None for ours.
        yields_above: Probability above which the answer is ``yields``.
        goes_below: Probability below which it is ``goes``; between both it is ``unclear``.

    Raises:
        ConfigError: If the file cannot be read, or a probability is out of range.
    """

    name = "learned"

    def __init__(self, file: Path | None, yields_above: float, goes_below: float) -> None:
        self.thresholds = thresholds(yields_above, goes_below)
        self.file = OURS if file is None else file.expanduser()
        self.weights, self.bias = load(self.file)

    def files(self) -> Mapping[str, Path]:
        return {"coefficients": self.file}

    def judge(self, asked: Sequence[Contest]) -> Judgements:
        return {(contest.cav, contest.human): self._judged(contest.numbers) for contest in asked}

    def _judged(self, numbers: Mapping[str, float]) -> Judgement:
        logit = self.bias + sum(weight * numbers[name] for name, weight in self.weights.items())
        yields = 1 / (1 + exp(-max(min(logit, 50.0), -50.0)))
        return said(round(yields, 6), f"{yields:.0%} of drivers in such a place let the CAV pass", *self.thresholds)


def load(file: Path) -> tuple[dict[str, float], float]:
    """Read the weight of each number, and the bias.

    Raises:
        ConfigError: If the file does not hold them.
    """
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
        weights = {str(name): float(weight) for name, weight in found["weights"].items()}
        bias = float(found["bias"])
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise ConfigError(f"file {file} holds no coefficients ({error}); make it with docs/judgement/fit.py") from error
    unknown = sorted(weights.keys() - FEATURES.keys())
    require(not unknown, f"file {file} weighs {', '.join(unknown)}, which are no numbers of a pair; fit it anew")
    require(all(np.isfinite([bias, *weights.values()])), f"file {file} holds a weight that is no number; fit it anew")
    return weights, bias


def fit(rows: Array, truth: Array, ridge: float = RIDGE) -> tuple[Array, float]:
    """Fit weights and bias of a logistic regression by Newton's method, the rows standardised and ridged.

    Args:
        rows: Numbers of each moment (n, k).
        truth: 1 where the driver let the CAV pass, else 0 (n,).
    """
    mean, scale = rows.mean(axis=0), rows.std(axis=0)
    scale[scale == 0] = 1.0
    x = np.column_stack([np.ones(len(rows)), (rows - mean) / scale])
    penalty = ridge * np.diag([0.0] + [1.0] * rows.shape[1])
    weights = np.zeros(x.shape[1])
    for _ in range(ROUNDS):
        p = 1 / (1 + np.exp(-np.clip(x @ weights, -50, 50)))
        gradient = x.T @ (p - truth) + penalty @ weights
        change = np.linalg.solve(x.T @ (x * (p * (1 - p))[:, None]) + penalty, gradient)
        weights -= change
        if np.abs(change).max() < 1e-10:
            break
    own = weights[1:] / scale
    return own, float(weights[0] - own @ mean)
