"""Our own metrics: every quantity by its definition, undefined where it does not apply."""

from dataclasses import replace
from itertools import combinations

import numpy as np

from codriving.datatypes import BLOCKER, Ending, Kind, Metric, NamedNumber, Outcome, Score, Trajectory, TravelScore
from codriving.errors import ConfigError
from codriving.geometry import TRUE, RoadMap
from codriving.metrics.comfort import hard_braking, hardest_braking, jerk, reversals, stops
from codriving.metrics.delay import drives, jain
from codriving.metrics.flows import flow_numbers
from codriving.metrics.following import Closest, closest
from codriving.metrics.from_behind import struck_from_behind
from codriving.metrics.pet import has_area, post_encroachment_times
from codriving.metrics.recorded import closest_recorded, driven_pets, driven_travels, who_count


class StandardMetrics(Metric):
    """Success, post-encroachment time and travel velocity (paper Section IV-A), near misses, comfort and delay.

    Args:
        free_speed: Speed that ``TravelScore.delay`` is counted against [m/s]; None takes the speed limits.
        near_miss: Least PET of a clean success [s]; least TTC on a road where no routes cross or merge.
        hard_braking: Braking above this is hard [m/s2].
    """

    name = "standard"
    against_alone, flows = True, True

    def __init__(self, free_speed: float | None = None, near_miss: float = 1.5, hard_braking: float = 3.4) -> None:
        if free_speed is not None and not free_speed > 0:
            raise ConfigError(
                f"metrics.free_speed must be > 0 m/s, got {free_speed:g}; leave it null for the speed limits"
            )
        for name, value, unit in (("near_miss", near_miss, "s"), ("hard_braking", hard_braking, "m/s2")):
            if not value > 0:
                raise ConfigError(f"metrics.{name} must be > 0 {unit}, got {value:g}")
        self.free_speed, self.near_miss, self.hard_braking = free_speed, near_miss, hard_braking

    def score(self, trajectory: Trajectory, outcome: Outcome, road: RoadMap) -> Score:
        """Return the score of an episode or of a flow."""
        if outcome.flow is not None:
            return Score(None, numbers=flow_numbers(trajectory, outcome, outcome.flow, road, self.hard_braking))
        success = outcome.ending is Ending.SUCCESS
        pets, nearest = post_encroachment_times(trajectory, road), closest(trajectory)
        if meets(road):
            missed = any(pet.value < self.near_miss for pet in pets)
        else:
            missed = nearest.ttc is not None and nearest.ttc < self.near_miss
        return Score(
            success=success,
            pets=pets,
            travels=travels(trajectory, road, self.free_speed),
            numbers=(*self._numbers(trajectory, road, nearest, success), *_forgiving(trajectory, outcome, success)),
            clean=success and not missed,
        )

    def score_recording(self, trajectory: Trajectory, outcome: Outcome) -> Score:
        """Return the score of trajectories of whose road nothing is known."""
        step, tracks, success = trajectory.step, who_count(trajectory), outcome.ending is Ending.SUCCESS
        pets, nearest = driven_pets(trajectory), closest_recorded(trajectory)
        numbers = (
            NamedNumber("ttc_min", nearest.ttc, "s", "higher"),
            NamedNumber("drac_max", nearest.drac, "m/s2", "lower"),
            NamedNumber("braking_max", hardest_braking(tracks, step), "m/s2", "lower"),
            NamedNumber("hard_braking", hard_braking(tracks, step, self.hard_braking), "", "lower"),
            NamedNumber("jerk", jerk(tracks, step), "m/s3", "lower"),
            NamedNumber("stops", stops(tracks), "", "lower"),
        )
        clean = success and all(pet.value >= self.near_miss for pet in pets)
        return Score(success, pets, driven_travels(tracks, step), numbers, clean=clean)

    def _numbers(
        self, trajectory: Trajectory, road: RoadMap, nearest: Closest, success: bool
    ) -> tuple[NamedNumber, ...]:
        step = trajectory.step
        driving = [track for track in trajectory.tracks if track.style != BLOCKER]
        cavs, hdvs = ([t for t in driving if t.kind is kind] for kind in (Kind.CAV, Kind.HDV))
        # How much time was lost is known once all have arrived.
        driven = drives(replace(trajectory, tracks=tuple(driving)), road) if success else ()
        cav_delay, hdv_delay = ([d.delay for d in driven if d.kind is kind] for kind in (Kind.CAV, Kind.HDV))
        return (
            NamedNumber("ttc_min", nearest.ttc, "s", "higher"),
            NamedNumber("drac_max", nearest.drac, "m/s2", "lower"),
            NamedNumber("hard_braking_cavs", hard_braking(cavs, step, self.hard_braking), "", "lower"),
            NamedNumber("hard_braking_hdvs", hard_braking(hdvs, step, self.hard_braking), "", "lower"),
            NamedNumber("jerk_cavs", jerk(cavs, step), "m/s3", "lower"),
            NamedNumber("jerk_hdvs", jerk(hdvs, step), "m/s3", "lower"),
            NamedNumber("stops_cavs", stops(cavs), "", "lower"),
            NamedNumber("stops_hdvs", stops(hdvs), "", "lower"),
            NamedNumber("reversals", reversals(cavs, step), "1/min", "lower"),
            NamedNumber("delay_cavs", _mean(cav_delay), "s", "lower"),
            NamedNumber("delay_hdvs", _mean(hdv_delay), "s", "lower"),
            NamedNumber("fairness", jain([d.alone / d.time for d in driven]), "", "higher"),
            NamedNumber("time_all", _mean([d.whole for d in driven]), "s", "lower"),
        )


def _forgiving(trajectory: Trajectory, outcome: Outcome, success: bool) -> tuple[NamedNumber, ...]:
    """Success if collisions in which a human driver hits a CAV from behind are forgiven, and whether this was one."""
    from_behind = struck_from_behind(trajectory, outcome)
    return (
        NamedNumber("struck_from_behind", float(from_behind), better="lower"),
        NamedNumber("success_forgiving", float(success or from_behind), better="higher"),
    )


def meets(road: RoadMap) -> bool:
    """Tell whether two routes of a road cross or merge anywhere."""
    pairs = combinations(road.routes, 2)
    return any(has_area(zone) for i, j in pairs for zone in road.zones(i, j, TRUE))


def _mean(values: list[float]) -> float | None:
    return sum(values) / len(values) if values else None


def travels(trajectory: Trajectory, road: RoadMap, free_speed: float | None = None) -> tuple[TravelScore, ...]:
    """Return how each CAV travelled; one that did not arrive is absent."""
    scores = []
    for track in trajectory.tracks:
        start = track.first_step * trajectory.step
        if track.kind is not Kind.CAV or track.arrived is None or track.arrived <= start:
            continue
        times = start + trajectory.step * np.arange(len(track.x))
        driven = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(track.x), np.diff(track.y)))))
        # Up to the arrival only: some vehicles stay on the road for a while after it.
        distance, time = float(np.interp(track.arrived, times, driven)), track.arrived - start
        speed = free_speed or max(road.lanes[lane].speed_limit for lane in road.routes[track.route].lanes)
        scores.append(TravelScore(track.id, distance / time, time, time - distance / speed))
    return tuple(scores)
