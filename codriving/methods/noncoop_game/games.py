"""All outcomes of two games: who passes first where ways meet, and a lane change in front of a follower."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from codriving.geometry import PLANNING, ConflictZone
from codriving.methods.noncoop_game.payoff import Array, Flags, Temper
from codriving.methods.single_vehicle.encounters import Encounter, leaders
from codriving.methods.single_vehicle.lane_choice import Side
from codriving.reasoning import SLOWEST, IntelligentDriver, Moment

ACCELERATIONS: Array = np.array([2.0, 0.0, -2.0, -4.0])  # What each player can choose from [m/s2]

YIELDS, STAYS = -2.0, 0.0  # Acceleration of a follower who yields, and of one who does not [m/s2]

KEEP, CHANGE = 0, 1  # Rows of the game


@dataclass(frozen=True, slots=True)
class Game:
    """All outcomes of a game of two: rows are the ego vehicle's accelerations, columns the other's."""

    choices: tuple[Array, Array]  # Accelerations of the ego vehicle (n,) and of the other one (m,) [m/s2]
    progress: Array  # Way covered by each acceleration, as a share of what is possible, of both players (2, n)
    gaps: Array  # Gap in time between the one that leaves a zone and the one that enters it next (n, m) [s]
    overlaps: Flags  # Whether the two come too close within the horizon (n, m)

    def own(self, temper: Temper) -> Array:
        """Payoff of the ego vehicle (n, m)."""
        return temper.payoff(self.progress[0][:, None], self.choices[0][:, None], self.gaps, self.overlaps)

    def other(self, temper: Temper) -> Array:
        """Payoff of the other one, if it is of a temper (n, m)."""
        return temper.payoff(self.progress[1][None, :], self.choices[1][None, :], self.gaps, self.overlaps)


@dataclass(frozen=True, slots=True)
class PassingGame(Game):
    """Who passes first."""

    own_first: Flags  # Whether the ego vehicle is at the most urgent zone first (n, m)


def passing_game(met: Sequence[Encounter], speed: float, top: float, hold: float, times: Array) -> PassingGame:
    """Work out all outcomes with one other vehicle, the worst of all ways that it may take."""
    own, own_last = constant_acceleration(speed, ACCELERATIONS, hold, top, times)
    its, its_last = constant_acceleration(met[0].other.speed, ACCELERATIONS, hold, top, times)
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
    progress = np.stack((own[:, -1], its[:, -1])) / (max(top, 0.1) * float(times[-1]))
    return PassingGame((ACCELERATIONS, ACCELERATIONS), progress, gaps, overlaps, first)


def _ends(zone: ConflictZone) -> tuple[float, float]:
    """Where each has left a zone as far as the other one is concerned: where ways merge, once it is a body ahead."""
    if zone.merge_i is None or zone.merge_j is None:
        return zone.exit_i, zone.exit_j
    return min(zone.exit_i, zone.merge_i + PLANNING.length), min(zone.exit_j, zone.merge_j + PLANNING.length)


def _minus(later: Array, earlier: Array) -> Array:
    """Difference of times of which both may be infinite: who never leaves gives no gap, who never comes gives one."""
    return np.asarray(np.where(np.isinf(earlier), -np.inf, later - np.where(np.isinf(earlier), 0.0, earlier)))


def _first(own_in: Array, its_in: Array, own_left: Array, its_left: Array) -> Flags:
    earlier = own_in[:, None] < its_in[None, :]
    level = own_in[:, None] == its_in[None, :]
    return np.asarray(earlier | (level & (own_left[:, None] <= its_left[None, :])))


def _overlap(zone: ConflictZone, own: Array, its: Array) -> Flags:
    """Whether two of the motions are ever too close (n, m)."""
    begin, end = zone.blocked(its)
    return np.asarray(((own[:, None, :] >= begin[None]) & (own[:, None, :] <= end[None])).any(axis=2))


def lane_game(moment: Moment, ego: str, side: Side, idm: IntelligentDriver, hold: float, times: Array) -> Game:
    """Work out all outcomes of a lane change: rows are to keep the lane and to change, columns to yield and not to."""
    speed, top, ahead, behind = moment.scenes[ego].ego.speed, moment.forecast.model.top_speed, side.ahead, side.behind
    assert behind is not None
    assert behind.gap is not None
    held_up = [idm.accelerate(speed, top, x.gap, x.speed) for x in leaders(moment.scenes[ego], moment.road_map)]
    here = min([*held_up, idm.accelerate(speed, top)])
    there = idm.accelerate(speed, top, None if ahead is None else ahead.gap, ahead.speed if ahead else 0.0)
    choices = np.array([here, there]), np.array([YIELDS, STAYS])
    own, own_last = constant_acceleration(speed, choices[0], hold, top, times)
    its, its_last = constant_acceleration(behind.speed, choices[1], hold, top, times)
    room = behind.gap + own[CHANGE] - its
    # A gap in time that closes at the end of the horizon counts as what will be left of it a second later.
    closing = np.minimum(own_last[CHANGE] - its_last, 0.0)
    gaps = np.maximum(np.minimum(room.min(axis=1), room[:, -1] + closing), 0.0) / np.maximum(its_last, SLOWEST)
    overlaps = np.stack((np.zeros(2, dtype=np.bool_), (room <= 0).any(axis=1)))
    progress = np.stack((own[:, -1], its[:, -1])) / (max(top, 0.1) * float(times[-1]))
    return Game(choices, progress, np.stack((np.full(2, inf), gaps)), overlaps)


def constant_acceleration(
    speed: float, accelerations: Array, hold: float, top: float, times: Array
) -> tuple[Array, Array]:
    """Return the motions that follow from several accelerations."""
    limit = np.where(accelerations > 0, max(top, speed), 0.0)
    # One that does not accelerate never comes to its limit.
    changing = np.where(accelerations == 0, 1.0, accelerations)
    until = np.where(accelerations == 0, hold, np.minimum((limit - speed) / changing, hold))
    last = speed + accelerations * until
    during = np.minimum(times[None, :], until[:, None])
    travelled = speed * during + accelerations[:, None] * during**2 / 2 + last[:, None] * (times[None, :] - during)
    return np.asarray(travelled), np.asarray(last)


def passage(distance: float, travelled: Array, last: Array, times: Array) -> Array:
    """Return when each motion has covered a distance."""
    if distance <= 0:
        return np.zeros(len(travelled))
    after = np.maximum((travelled < distance).sum(axis=1), 1)
    inside = after < len(times)
    k = np.minimum(after, len(times) - 1)
    rows = np.arange(len(travelled))
    begin, end = travelled[rows, k - 1], travelled[rows, k]
    share = np.where(inside, (distance - begin) / np.maximum(end - begin, 1e-9), 0.0)
    within = times[k - 1] + share * (times[k] - times[k - 1])
    moves = last > 1e-6
    beyond = times[-1] + np.where(moves, (distance - travelled[:, -1]) / np.where(moves, last, 1.0), np.inf)
    return np.asarray(np.where(inside, within, beyond))
