"""The game of a lane change: to keep the lane or to change, against a follower there who yields or does not."""

from math import inf

import numpy as np
from numpy.typing import NDArray

from codriving.methods.noncoop_game.held import held
from codriving.methods.noncoop_game.payoff import Temper
from codriving.methods.single_vehicle.lane_choice import Side
from codriving.methods.single_vehicle.leaders import leaders
from codriving.methods.single_vehicle.protocol import View
from codriving.reasoning.prediction.idm import IntelligentDriver
from codriving.reasoning.severity import SLOWEST

Array = NDArray[np.float64]

YIELDS, STAYS = -2.0, 0.0
"""Acceleration of a follower who yields, and of one who does not [m/s2]."""

KEEP, CHANGE = 0, 1
"""Rows of the game."""


class LaneGame:
    """All outcomes of one lane change: rows are to keep the lane and to change, columns to yield and not to.

    Args:
        hold: How long an acceleration is held [s].
        times: Times of the horizon, the first of them 0 (k,) [s].
    """

    def __init__(self, view: View, side: Side, idm: IntelligentDriver, hold: float, times: Array) -> None:
        ego, behind = view.scene.ego, side.behind
        assert behind is not None
        assert behind.gap is not None
        here = min(
            (idm.accelerate(ego.speed, view.top, x.gap, x.speed) for x in leaders(view.scene, view.road_map)),
            default=inf,
        )
        here = min(here, idm.accelerate(ego.speed, view.top))
        ahead = side.ahead
        there = idm.accelerate(ego.speed, view.top, None if ahead is None else ahead.gap, ahead.speed if ahead else 0.0)
        self._own = np.array([here, there])
        self._its = np.array([YIELDS, STAYS])
        own, own_last = held(ego.speed, self._own, hold, view.top, times)
        its, its_last = held(behind.speed, self._its, hold, view.top, times)
        room = behind.gap + own[CHANGE] - its
        # A gap in time that closes at the end of the horizon counts as what will be left of it a second later.
        closing = np.minimum(own_last[CHANGE] - its_last, 0.0)
        gaps = np.maximum(np.minimum(room.min(axis=1), room[:, -1] + closing), 0.0) / np.maximum(its_last, SLOWEST)
        self._gaps = np.stack((np.full(2, inf), gaps))
        self._overlaps = np.stack((np.zeros(2, dtype=np.bool_), (room <= 0).any(axis=1)))
        possible = max(view.top, 0.1) * float(times[-1])
        self._progress = np.stack((own[:, -1], its[:, -1])) / possible

    def own(self, temper: Temper) -> Array:
        """Payoff of the ego vehicle (2, 2)."""
        return temper.payoff(self._progress[0][:, None], self._own[:, None], self._gaps, self._overlaps)

    def other(self, temper: Temper) -> Array:
        """Payoff of the follower, if it is of a temper (2, 2)."""
        return temper.payoff(self._progress[1][None, :], self._its[None, :], self._gaps, self._overlaps)
