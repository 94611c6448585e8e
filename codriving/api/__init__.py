"""The commands as calls from Python: what they give are data frames, and what goes wrong is an exception."""

from codriving.api.calls import ablate, compare, learn, load, run, score

__all__ = ["ablate", "compare", "learn", "load", "run", "score"]
