"""From a driven trajectory to its score: success, post-encroachment time, travel velocity."""

from codriving.metrics.intervals import FEWEST, RESAMPLES, mcnemar, mean_interval, rate_interval, wilson_interval
from codriving.metrics.scorer import Scorer, with_alone

__all__ = [
    "FEWEST", "RESAMPLES", "Scorer", "mcnemar", "mean_interval", "rate_interval", "wilson_interval", "with_alone",
]  # fmt: skip
