"""Trajectory -> score: success, near misses, velocity, comfort and delay; and what is counted of a flow."""

from codriving.metrics.intervals import (
    FEWEST,
    RESAMPLES,
    holm,
    mcnemar,
    mean_interval,
    paired_interval,
    rate_interval,
    wilson_interval,
)
from codriving.metrics.pet import post_encroachment_times
from codriving.metrics.recorded import outcome_of, recorded_time
from codriving.metrics.scorer import Scorer, with_alone

__all__ = [
    "FEWEST", "RESAMPLES", "Scorer", "holm", "mcnemar", "mean_interval", "outcome_of", "paired_interval",
    "post_encroachment_times", "rate_interval", "recorded_time", "wilson_interval", "with_alone",
]  # fmt: skip
