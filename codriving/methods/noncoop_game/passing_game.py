"""The game of two vehicles whose ways meet: who accelerates, and who lets the other one pass."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.geometry.box import PLANNING
from codriving.geometry.zone import ConflictZone
from codriving.methods.noncoop_game.held import held, passage
from codriving.methods.noncoop_game.payoff import Temper
from codriving.methods.single_vehicle.encounters import Encounter

Array = NDArray[np.float64]

ACCELERATIONS: Array = np.array([2.0, 0.0, -2.0, -4.0])
"""What each player can choose from [m/s2]."""


@dataclass(frozen=True, slots=True)
class PassingGame:
    """All outcomes of one game: rows are the ego vehicle's accelerations, columns the other's.

    Attributes:
        progress: Way covered by each acceleration, as a share of what is possible, of both players (2, 4).
        gaps: Gap in time between the one that leaves a zone and the one that enters it next (4, 4) [s].
        overlaps: Whether the two come too close within the horizon (4, 4).
        own_first: Whether the ego vehicle is at the most urgent zone first (4, 4).
    """

    progress: Array
    gaps: Array
    overlaps: NDArray[np.bool_]
    own_first: NDArray[np.bool_]

    def own(self, temper: Temper) -> Array:
        """Payoff of the ego vehicle (4, 4)."""
        return temper.payoff(self.progress[0][:, None], ACCELERATIONS[:, None], self.gaps, self.overlaps)

    def other(self, temper: Temper) -> Array:
        """Payoff of the other one, if it is of a temper (4, 4)."""
        return temper.payoff(self.progress[1][None, :], ACCELERATIONS[None, :], self.gaps, self.overlaps)


def passing_game(met: Sequence[Encounter], speed: float, top: float, hold: float, times: Array) -> PassingGame:
    """Work out all outcomes with one other vehicle, the worst of all ways that it may take.

    Args:
        speed: Speed of the ego vehicle [m/s].
        top: Highest target speed [m/s].
        hold: How long an acceleration is held [s].
        times: Times of the horizon, the first of them 0 (k,) [s].
    """
    own, own_last = held(speed, ACCELERATIONS, hold, top, times)
    its, its_last = held(met[0].other.speed, ACCELERATIONS, hold, top, times)
    gaps = np.full((len(own), len(its)), np.inf)
    overlaps = np.zeros(gaps.shape, dtype=np.bool_)
    first = np.zeros(gaps.shape, dtype=np.bool_)
    for k, e in enumerate(met):
        own_out, its_out = _ends(e.zone)
        place, there = e.conflict.places
        own_in = passage(e.zone.entry_i - place, own, own_last, times)
        its_in = passage(e.zone.entry_j - there, its, its_last, times)
        own_left = passage(own_out - place, own, own_last, times)
        its_left = passage(its_out - there, its, its_last, times)
        gap = np.maximum(_minus(its_in[None, :], own_left[:, None]), _minus(own_in[:, None], its_left[None, :]))
        gaps = np.minimum(gaps, np.maximum(gap, 0.0))
        overlaps |= _overlap(e.zone, place + own, there + its)
        if k == 0:
            first = _first(own_in, its_in, own_left, its_left)
    possible = max(top, 0.1) * float(times[-1])
    return PassingGame(np.stack((own[:, -1], its[:, -1])) / possible, gaps, overlaps, first)


def _ends(zone: ConflictZone) -> tuple[float, float]:
    """Where each has left a zone as far as the other one is concerned: where ways merge, once it is a body ahead."""
    if zone.merge_i is None or zone.merge_j is None:
        return zone.exit_i, zone.exit_j
    return min(zone.exit_i, zone.merge_i + PLANNING.length), min(zone.exit_j, zone.merge_j + PLANNING.length)


def _minus(later: Array, earlier: Array) -> Array:
    """Difference of times of which both may be infinite: who never leaves gives no gap, who never comes gives one."""
    return np.asarray(np.where(np.isinf(earlier), -np.inf, later - np.where(np.isinf(earlier), 0.0, earlier)))


def _first(own_in: Array, its_in: Array, own_left: Array, its_left: Array) -> NDArray[np.bool_]:
    earlier = own_in[:, None] < its_in[None, :]
    level = own_in[:, None] == its_in[None, :]
    return np.asarray(earlier | (level & (own_left[:, None] <= its_left[None, :])))


def _overlap(zone: ConflictZone, own: Array, its: Array) -> NDArray[np.bool_]:
    """Whether two of the motions are ever too close (n, m)."""
    begin, end = zone.blocked(its)
    return np.asarray(((own[:, None, :] >= begin[None]) & (own[:, None, :] <= end[None])).any(axis=2))
