"""How fast any way of driving can be at most: a lower bound of the sum of arrivals, and what it rests on."""

from codriving.bound.meetings import Margins
from codriving.bound.witness import witness
from codriving.bound.world import BoundedWorld, bounded_world

__all__ = ["BoundedWorld", "Margins", "bounded_world", "witness"]
