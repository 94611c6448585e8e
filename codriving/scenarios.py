"""Seed to scene: the roads, the places where vehicles start and where they want to go.

What a scenario is made of can be imported from here, for scenarios of your own: the road as data (``Road``, ``Lane``,
``Route`` and their parts), the settings that all scenarios share (``Crowd``, ``Pace``) and their checks, and ``place``,
which draws a scene.
"""

from codriving.datatypes import (
    Arc,
    Block,
    Kind,
    Lane,
    LaneId,
    Line,
    Point,
    Road,
    Route,
    Scenario,
    Scene,
    Sine,
    Start,
    Straight,
    Turn,
)
from codriving.environment import Crowd, Pace, bend, place, turned
from codriving.errors import require, require_interval, require_range
from codriving.geometry import lane_starts

__all__ = [
    "Arc",
    "Block",
    "Crowd",
    "Kind",
    "Lane",
    "LaneId",
    "Line",
    "Pace",
    "Point",
    "Road",
    "Route",
    "Scenario",
    "Scene",
    "Sine",
    "Start",
    "Straight",
    "Turn",
    "bend",
    "lane_starts",
    "place",
    "require",
    "require_interval",
    "require_range",
    "turned",
]
