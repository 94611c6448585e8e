"""The non-cooperative game: each vehicle plays against its most critical partner, whose temper it does not know."""

from collections.abc import Mapping, Sequence

import numpy as np

from codriving.datatypes.order import Precedence
from codriving.errors import ConfigError
from codriving.methods.noncoop_game.lane_game import CHANGE, KEEP, LaneGame
from codriving.methods.noncoop_game.nash import Array, best_answer, expected_action
from codriving.methods.noncoop_game.passing_game import ACCELERATIONS, PassingGame, passing_game
from codriving.methods.noncoop_game.payoff import Temper
from codriving.methods.noncoop_game.stubborn import Stubborn
from codriving.methods.pidm import ProjectedIdm
from codriving.methods.single_vehicle.action_mapping import closest_action, mean_accelerations
from codriving.methods.single_vehicle.encounters import Encounter
from codriving.methods.single_vehicle.expected_first import goes_first
from codriving.methods.single_vehicle.lane_choice import Side
from codriving.methods.single_vehicle.patience import Patience
from codriving.methods.single_vehicle.protocol import Choice, Driver, View
from codriving.reasoning.prediction.idm import IntelligentDriver

UNBRAKED = int(np.sum(ACCELERATIONS >= 0))
"""Number of accelerations without braking; they are the first ones."""


class NonCooperativeGame(Driver):
    """A simultaneous game of two players with a private type, replanned each decision (after Fang et al., 2024).

    The partner is whoever meets the vehicle most urgently. Everybody else is minded as projected IDM minds them.

    Args:
        hold: How long an acceleration is held; then the speed is kept [s].
        horizon: Time over which a game is judged [s].
        sample: Time between two places that are compared [s].

    Raises:
        ConfigError: If a setting is out of range.
    """

    name = "noncoop_game"
    variant = ""

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
        for key, value, low, high in (
            ("sample", sample, 0.05, 1.0),
            ("horizon", horizon, 1.0, 10.0),
            ("hold", hold, 0.1, horizon),
            ("indifference", indifference, 0.0, 100.0),
        ):
            if not low <= value <= high:
                raise ConfigError(f"{key} must be {low:g} to {high:g}, got {value:g}")
        self.tempers, self.own, self.shares = tuple(tempers.values()), tempers[own], shares
        self.hold, self.indifference, self.others = hold, indifference, others
        self.times: Array = np.arange(round(horizon / sample) + 1, dtype=np.float64) * sample
        self._patience, self._stubborn = Patience(), Stubborn()

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self._patience = Patience()
        self._stubborn = Stubborn()
        self.others.reset()

    def decide(self, view: View) -> Choice:
        """Play against the most critical partner, mind everybody else, or change lanes if that game is worth it."""
        ego = view.scene.ego
        waited = self._patience.waited(ego.id, ego.speed, view.time)
        change, refused = self.others.lanes.choose(view, self.others.idm, self.refuses)
        if change is not None:
            return Choice(change.action, change.reason, (), refused)
        met = self.others.met(view)
        partner = met[0].conflict.other if met else ""
        rest = tuple(e for e in met if e.conflict.other != partner)
        crept = self.others.may_start(view, met, waited)
        wished, why, precedences = self.others.wish(view, met if crept else rest, waited)
        if partner and not crept:
            played, said, precedence = self.play(view, [e for e in met if e.conflict.other == partner])
            precedences = (precedence, *precedences)
            if played <= wished:
                wished, why = played, said
        means = mean_accelerations(view.forecast, ego.speed, view.scene.intent.target_speed, self.others.window)
        action = closest_action(wished, means, self.others.brake_at)
        counts = {"games": int(bool(partner) and not crept), "creeps": int(crept)}
        return Choice(action, f"{why}; it wishes {wished:+.1f} m/s2", precedences, refused, counts)

    def play(self, view: View, met: Sequence[Encounter]) -> tuple[float, str, Precedence]:
        """Play against one partner.

        Returns:
            Acceleration [m/s2], why, and who goes first by that.
        """
        ego, other = view.scene.ego, met[0].other
        game = passing_game(met, ego.speed, view.top, self.hold, self.times)
        # Only who is first on every way that the partner may take can be: so two can never both believe that they are.
        first = all(goes_first(e, view.road_map, self.others.tie)[0] for e in met)
        stubborn = self._stubborn.keeps_on(ego.id, other.id, other.speed)
        answers = self.answers(game, first, UNBRAKED if stubborn else len(ACCELERATIONS))
        if not stubborn and all(ACCELERATIONS[k] < 0 for k in answers):
            self._stubborn.expected_to_brake(ego.id, other.id, other.speed)
        row, _ = best_answer(game.own(self.own), answers, self.shares)
        likely = answers[int(np.argmax(self.shares))]
        leads = bool(game.own_first[row, likely])
        pair = (ego.id, other.id) if leads else (other.id, ego.id)
        said = f"the game with {other.id}, expected to choose {_steps(answers)} m/s2"
        return float(ACCELERATIONS[row]), said, Precedence(*pair, f"{pair[0]} is first by {said}")

    def answers(self, game: PassingGame, first: bool, among: int = len(ACCELERATIONS)) -> tuple[int, ...]:
        """Return the action that is expected of a partner of each type."""
        own = game.own(self.own)[:, :among]

        def agreed(row: int, column: int) -> bool:
            return bool(game.own_first[row, column]) is first

        return tuple(
            expected_action(own, game.other(temper)[:, :among], self.indifference, agreed)[0] for temper in self.tempers
        )

    def refuses(self, view: View, side: Side, idm: IntelligentDriver) -> str:
        """Say why the game of a lane change ends with keeping the lane; nothing if it ends with the change."""
        if side.behind is None or side.behind.gap is None:
            return ""
        game = LaneGame(view, side, idm, self.hold, self.times)
        own = game.own(self.own)
        answers = tuple(
            expected_action(own, game.other(temper), 0.0, lambda row, _: row == KEEP)[0] for temper in self.tempers
        )
        row, expected = best_answer(own, answers, self.shares)
        if row == CHANGE:
            return ""
        worth = f"{expected[KEEP]:.1f} on this lane and {expected[CHANGE]:.1f} on that one"
        return f"the game with {side.behind.id} is worth {worth}"


def _steps(answers: tuple[int, ...]) -> str:
    return " or ".join(dict.fromkeys(f"{ACCELERATIONS[k]:+.0f}" for k in answers))
