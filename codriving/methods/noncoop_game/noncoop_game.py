"""The non-cooperative game: each vehicle plays against its most critical partner, whose temper it does not know."""

from collections.abc import Mapping, Sequence

import numpy as np

from codriving.datatypes import Precedence
from codriving.errors import ConfigError, require_range
from codriving.methods.noncoop_game.games import ACCELERATIONS, CHANGE, KEEP, PassingGame, lane_game, passing_game
from codriving.methods.noncoop_game.payoff import Array, Temper, best_answer, expected_action
from codriving.methods.pidm import ProjectedIdm, closest_action, mean_accelerations
from codriving.methods.single_vehicle.encounters import Encounter, Patience, goes_first
from codriving.methods.single_vehicle.lane_choice import Side
from codriving.methods.single_vehicle.method import Choice, Driver
from codriving.reasoning import IntelligentDriver, Moment

UNBRAKED = int(np.sum(ACCELERATIONS >= 0))  # Number of accelerations without braking; they are the first ones

BRAKES = 0.5  # How much slower a vehicle must have become to count as braking [m/s]


class NonCooperativeGame(Driver):
    """A simultaneous game of two players with a private type, replanned each decision (after Fang et al., 2024).

    The partner is the vehicle that is met most urgently. All others are minded as projected IDM minds them.
    """

    name = "noncoop_game"

    def __init__(
        self,
        tempers: Mapping[str, Temper],
        own: str,
        hold: float,
        horizon: float,
        sample: float,
        indifference: float,
        others: ProjectedIdm,
    ) -> None:
        if own not in tempers:
            raise ConfigError(f"own must be one of {', '.join(tempers)}, got {own}")
        shares = np.array([temper.share for temper in tempers.values()])
        if abs(float(shares.sum()) - 1) > 1e-6:
            raise ConfigError(f"tempers: their shares must add up to 1, got {float(shares.sum()):g}")
        require_range("sample", sample, 0.05, 1.0)
        require_range("horizon", horizon, 1.0, 10.0)
        require_range("hold", hold, 0.1, horizon)
        require_range("indifference", indifference, 0.0, 100.0)
        self.tempers, self.own, self.shares = tuple(tempers.values()), tempers[own], shares
        self.hold, self.indifference, self.others = hold, indifference, others
        self.times: Array = np.arange(round(horizon / sample) + 1, dtype=np.float64) * sample
        self._patience, self._unmet = Patience(), UnmetExpectations()

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self._patience, self._unmet = Patience(), UnmetExpectations()
        self.others.reset()

    def decide(self, moment: Moment, ego: str) -> Choice:
        """Play against the most critical partner, mind all others, or change lanes if that game is worth it."""
        own = moment.scenes[ego].ego
        waited = self._patience.waited(ego, own.speed, moment.time)
        change, refused = self.others.lanes.choose(moment, ego, self.others.idm, self.refuses)
        if change is not None:
            return Choice(change.action, change.reason, (), refused)
        met = self.others.met(moment, ego)
        partner = met[0].conflict.other if met else ""
        rest = tuple(e for e in met if e.conflict.other != partner)
        crept = self.others.may_start(moment, ego, met, waited)
        wished, why, precedences = self.others.wish(moment, ego, met if crept else rest, waited)
        if partner and not crept:
            played, said, precedence = self.play(moment, ego, [e for e in met if e.conflict.other == partner])
            precedences = (precedence, *precedences)
            if played <= wished:
                wished, why = played, said
        scene = moment.scenes[ego]
        means = mean_accelerations(
            moment.forecast, own.speed, scene.intent.target_speed, scene.where, self.others.window
        )
        action = closest_action(wished, means, self.others.brake_at)
        counts = {"games": int(bool(partner) and not crept), "creeps": int(crept)}
        return Choice(action, f"{why}; it wishes {wished:+.1f} m/s2", precedences, refused, counts)

    def play(self, moment: Moment, ego: str, met: Sequence[Encounter]) -> tuple[float, str, Precedence]:
        """Play against one partner."""
        speed, other = moment.scenes[ego].ego.speed, met[0].other
        game = passing_game(met, speed, moment.forecast.model.top_speed, self.hold, self.times)
        # Only who is first on every way that the partner may take can be: so two can never both believe that they are.
        first = all(goes_first(e, moment.road_map, self.others.tie)[0] for e in met)
        does_not_yield = self._unmet.does_not_yield(ego, other.id, other.speed)
        answers = self.answers(game, first, UNBRAKED if does_not_yield else len(ACCELERATIONS))
        if not does_not_yield and all(ACCELERATIONS[k] < 0 for k in answers):
            self._unmet.expected_to_brake(ego, other.id, other.speed)
        row, _ = best_answer(game.own(self.own), answers, self.shares)
        likely = answers[int(np.argmax(self.shares))]
        pair = (ego, other.id) if game.own_first[row, likely] else (other.id, ego)
        said = f"the game with {other.id}, expected to choose {_steps(answers)} m/s2"
        return float(ACCELERATIONS[row]), said, Precedence(*pair, f"{pair[0]} is first by {said}")

    def answers(self, game: PassingGame, first: bool, among: int = len(ACCELERATIONS)) -> tuple[int, ...]:
        """Return the action that is expected of a partner of each type."""
        own = game.own(self.own)[:, :among]

        def agreed(row: int, column: int) -> bool:
            return bool(game.own_first[row, column]) is first

        others = (game.other(temper)[:, :among] for temper in self.tempers)
        return tuple(expected_action(own, other, self.indifference, agreed)[0] for other in others)

    def refuses(self, moment: Moment, ego: str, side: Side, idm: IntelligentDriver) -> str:
        """Say why the game of a lane change ends with keeping the lane; nothing if it ends with the change."""
        if side.behind is None or side.behind.gap is None:
            return ""
        game = lane_game(moment, ego, side, idm, self.hold, self.times)
        own = game.own(self.own)
        others = (game.other(temper) for temper in self.tempers)
        answers = tuple(expected_action(own, other, 0.0, lambda row, _: row == KEEP)[0] for other in others)
        row, expected = best_answer(own, answers, self.shares)
        worth = f"{expected[KEEP]:.1f} on this lane and {expected[CHANGE]:.1f} on that one"
        return "" if row == CHANGE else f"the game with {side.behind.id} is worth {worth}"


def _steps(answers: tuple[int, ...]) -> str:
    return " or ".join(dict.fromkeys(f"{ACCELERATIONS[k]:+.0f}" for k in answers))


class UnmetExpectations:
    """Remembers of whom it was expected to brake, and how fast it was then."""

    def __init__(self) -> None:
        self._speeds: dict[tuple[str, str], float] = {}

    def expected_to_brake(self, ego: str, other: str, speed: float) -> None:
        """Note that a vehicle should brake from now on."""
        self._speeds[ego, other] = speed

    def does_not_yield(self, ego: str, other: str, speed: float) -> bool:
        """Whether a vehicle was expected to brake before and has not; once it does, it is expected to again."""
        before = self._speeds.get((ego, other))
        if before is not None and speed <= before - BRAKES:
            del self._speeds[ego, other]
        return (ego, other) in self._speeds
