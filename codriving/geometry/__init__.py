"""Shapes: paths by arc length, oriented boxes, and the conflict zones between routes."""

from codriving.geometry.box import PLANNING, TRUE, Footprint, corners, overlap, overlaps, separation
from codriving.geometry.clearance import (
    Array,
    Flags,
    Steps,
    covered_after,
    first_overlap,
    first_true,
    halts_behind,
    reacts,
    stays_ahead,
    stays_behind,
)
from codriving.geometry.collision_set import collision_set
from codriving.geometry.curve import FloatArray
from codriving.geometry.lane_path import lane_path, lane_starts
from codriving.geometry.limited import Along, accelerated, driven, limited
from codriving.geometry.path import Path, progress, squared_distance
from codriving.geometry.road_map import RoadMap, road_map
from codriving.geometry.search import Search, SearchedDrive
from codriving.geometry.speed_profile import SpeedProfile
from codriving.geometry.target_steps import TargetSteps
from codriving.geometry.unlimited import unlimited
from codriving.geometry.zone import ConflictZone, FollowingBand

__all__ = [
    "PLANNING", "TRUE", "Along", "Array", "ConflictZone", "Flags", "FloatArray", "FollowingBand", "Footprint",
    "Path", "RoadMap", "Search", "SearchedDrive", "SpeedProfile", "Steps", "TargetSteps", "accelerated",
    "collision_set", "corners", "covered_after", "driven", "first_overlap", "first_true", "halts_behind",
    "lane_path", "lane_starts", "limited", "overlap", "overlaps", "progress", "reacts", "road_map", "separation",
    "squared_distance", "stays_ahead", "stays_behind", "unlimited",
]  # fmt: skip
