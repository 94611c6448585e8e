"""PIDM: the Intelligent Driver Model, for which whoever is expected first at a junction drives ahead."""

from math import cos, inf

from codriving.datatypes.order import Precedence
from codriving.errors import ConfigError
from codriving.methods.single_vehicle.action_mapping import closest_action, mean_accelerations
from codriving.methods.single_vehicle.encounters import FRONT, Encounter, crossing_angle, encounters
from codriving.methods.single_vehicle.expected_first import goes_first
from codriving.methods.single_vehicle.lane_choice import LaneChoice
from codriving.methods.single_vehicle.leaders import leaders
from codriving.methods.single_vehicle.patience import Patience
from codriving.methods.single_vehicle.protocol import Choice, Driver, View
from codriving.methods.single_vehicle.starting import may_start
from codriving.reasoning.prediction.idm import IntelligentDriver

LIMITS = {
    "acceleration": (0.1, 10.0),
    "deceleration": (0.1, 10.0),
    "hardest": (1.0, 15.0),
    "gap": (0.0, 20.0),
    "headway": (0.0, 5.0),
    "projection": (0.0, 20.0),
    "stop_gap": (0.0, 20.0),
    "tie": (0.0, 5.0),
    "firm": (0.5, 10.0),
    "patience": (0.0, 60.0),
    "clear": (0.0, 10.0),
    "window": (0.1, 5.0),
    "brake_at": (0.0, 10.0),
}
"""Least and largest value of each setting."""


class ProjectedIdm(Driver):
    """A driver who follows real leaders, and those whom it projects onto its lane (after Kreutz and Eggert, 2021).

    Args:
        acceleration: IDM, largest acceleration [m/s2].
        deceleration: IDM, comfortable braking [m/s2].
        hardest: IDM, hardest braking that is asked for [m/s2].
        gap: IDM, distance kept at a standstill [m].
        headway: IDM, desired time gap [s].
        projection: Distance kept from a projected leader beyond a body length [m].
        stop_gap: Distance from the zone at which the vehicle waits [m].
        tie: Difference of the times to a zone up to which both count as there at once [s].
        firm: Braking beyond which nobody is expected to wait any more [m/s2].
        patience: Time after which a waiting vehicle may start into an empty zone [s].
        clear: Time that whoever moves towards that zone must be away from it beyond what the start takes [s].
        window: Time over which what an action leads to is compared with what is wished [s].
        brake_at: Braking beyond which the answer is always SLOWER [m/s2].

    Raises:
        ConfigError: If a setting is out of range.
    """

    name = "pidm"
    variant = ""

    def __init__(
        self,
        acceleration: float,
        deceleration: float,
        hardest: float,
        gap: float,
        headway: float,
        projection: float,
        stop_gap: float,
        tie: float,
        firm: float,
        patience: float,
        clear: float,
        window: float,
        brake_at: float,
        lanes: LaneChoice,
    ) -> None:
        given = {key: value for key, value in locals().items() if key in LIMITS}
        for key, value in given.items():
            low, high = LIMITS[key]
            if not low <= value <= high:
                raise ConfigError(f"{key} must be {low:g} to {high:g}, got {value:g}")
        self.idm = IntelligentDriver(gap, headway, acceleration, deceleration, hardest)
        self.projection, self.stop_gap, self.tie, self.firm = projection, stop_gap, tie, firm
        self.patience, self.clear, self.window, self.brake_at = patience, clear, window, brake_at
        self.lanes = lanes
        self._patience = Patience()

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self._patience = Patience()
        self.lanes.reset()

    def decide(self, view: View) -> Choice:
        """Follow whoever is most in the way, or change lanes if that is better."""
        scene = view.scene
        waited = self._patience.waited(scene.ego.id, scene.ego.speed, view.time)
        change, refused = self.lanes.choose(view, self.idm)
        if change is not None:
            return Choice(change.action, change.reason, (), refused)
        met = self.met(view)
        wished, why, precedences = self.wish(view, met, waited)
        means = mean_accelerations(view.forecast, scene.ego.speed, scene.intent.target_speed, self.window)
        action = closest_action(wished, means, self.brake_at)
        reason = f"{why}; IDM wishes {wished:+.1f} m/s2"
        return Choice(action, reason, precedences, refused, {"creeps": int(self.may_start(view, met, waited))})

    def met(self, view: View) -> tuple[Encounter, ...]:
        """Return where it is open who goes first, most urgent first."""
        return encounters(view, float(view.forecast.reach(view.scene.ego.speed, True).least[-1]), self.firm)

    def wish(self, view: View, met: tuple[Encounter, ...], waited: float) -> tuple[float, str, tuple[Precedence, ...]]:
        """Return the acceleration that is wished.

        Args:
            waited: How long it has been standing [s].

        Returns:
            Acceleration [m/s2], why, and who goes first wherever it is open.
        """
        scene = view.scene
        speed, top = scene.ego.speed, view.top
        options = [(self.idm.accelerate(speed, top), "nobody holds it up")]
        for ahead in leaders(scene, view.road_map):
            options.append((self.idm.accelerate(speed, top, ahead.gap, ahead.speed), f"{ahead.id} is ahead"))
        creeps = self.may_start(view, met, waited)
        precedences: dict[str, Precedence] = {}
        for e in met:
            first, why = goes_first(e, view.road_map, self.tie)
            if not first and creeps:
                first, why = True, f"it has waited for {waited:.0f} s and the zone is empty"
            other = e.conflict.other
            if first:
                precedences.setdefault(other, Precedence(scene.ego.id, other, why))
                continue
            if other not in precedences or precedences[other].first == scene.ego.id:
                precedences[other] = Precedence(other, scene.ego.id, why)
            options.append((self._behind(e, self._line(e, met), view), f"{other} goes first: {why}"))
        # Of several that wish the same the first one counts, so that nobody is named who is not in the way.
        wished, why = min(options, key=lambda option: option[0])
        return wished, why, tuple(precedences.values())

    def _line(self, e: Encounter, met: tuple[Encounter, ...]) -> float:
        """How far away a vehicle waits before a zone: not inside another crossing, where it would be in the way [m]."""
        line = e.own_way - self.stop_gap
        # From the last crossing to the first, since stepping back from one may lead into the one before.
        for other in sorted(met, key=lambda x: -x.own_way):
            if other.own_way > 0 and not other.merges() and other.own_way < line < other.conflict.exits[0]:
                line = other.own_way - self.stop_gap
        return line

    def _behind(self, e: Encounter, line: float, view: View) -> float:
        """The acceleration behind somebody who goes first: to follow its projection, or to stop before the zone."""
        speed = view.scene.ego.speed
        waiting = inf if e.inside else self.idm.accelerate(speed, view.top, line, 0.0)
        if e.other_inside and not e.merges():
            return waiting if waiting < inf else -self.idm.hardest
        along = max(cos(crossing_angle(e.conflict, e.zone, view.road_map)), 0.0)
        lead = e.own_way - e.its_way - 2 * FRONT - self.projection
        following = self.idm.accelerate(speed, view.top, lead, e.other.speed * along)
        return following if waiting == inf else max(following, waiting)

    def may_start(self, view: View, met: tuple[Encounter, ...], waited: float) -> bool:
        """Whether the CAV has waited long enough, and nobody is in the zones ahead or will be before it is through.

        Args:
            waited: How long it has been standing [s].
        """
        return may_start(view, met, waited, self.patience, self.clear)
