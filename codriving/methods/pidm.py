"""PIDM: the Intelligent Driver Model, for which the vehicle that is expected first at a junction drives ahead."""

from dataclasses import dataclass
from math import cos, inf

from codriving.datatypes import Action, Precedence
from codriving.methods.single_vehicle.encounters import FRONT, Encounter, WaitingDriver, crossing_angle, leaders
from codriving.methods.single_vehicle.method import Choice
from codriving.reasoning import Forecast, IntelligentDriver, Moment, Plan, rollout

SPEED_ACTIONS = (Action.SLOWER, Action.IDLE, Action.FASTER)

# Each action carried out once.
ONCE: tuple[Plan, ...] = ((Action.SLOWER, Action.IDLE), (Action.IDLE,), (Action.FASTER, Action.IDLE))

# Least and largest value of each setting.
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


@dataclass(kw_only=True, eq=False, repr=False)
class ProjectedIdm(WaitingDriver):
    """A driver who follows real leaders, and those whom it projects onto its lane (after Kreutz and Eggert, 2021)."""

    name = "pidm"
    ranges = LIMITS

    acceleration: float
    deceleration: float
    hardest: float
    gap: float
    headway: float
    projection: float
    stop_gap: float
    window: float
    brake_at: float

    def __post_init__(self) -> None:
        super().__post_init__()
        self.idm = IntelligentDriver(self.gap, self.headway, self.acceleration, self.deceleration, self.hardest)

    def decide(self, moment: Moment, ego: str) -> Choice:
        """Follow the vehicle that is most in the way, or change lanes if that is better."""
        scene = moment.scenes[ego]
        waited = self._patience.waited(ego, scene.ego.speed, moment.time)
        change, refused = self.lanes.choose(moment, ego, self.idm)
        if change is not None:
            return Choice(change.action, change.reason, (), refused)
        met = self.met(moment, ego)
        wished, why, precedences = self.wish(moment, ego, met, waited)
        means = mean_accelerations(
            moment.forecast, scene.ego.speed, scene.intent.target_speed, scene.where, self.window
        )
        action = closest_action(wished, means, self.brake_at)
        reason = f"{why}; IDM wishes {wished:+.1f} m/s2"
        return Choice(action, reason, precedences, refused, {"creeps": int(self.may_start(moment, ego, met, waited))})

    def wish(
        self, moment: Moment, ego: str, met: tuple[Encounter, ...], waited: float
    ) -> tuple[float, str, tuple[Precedence, ...]]:
        """Return the acceleration that is wished."""
        scene = moment.scenes[ego]
        speed, top = scene.ego.speed, moment.forecast.model.top_speed
        options = [(self.idm.accelerate(speed, top), "no vehicle holds it up")]
        for ahead in leaders(scene, moment.road_map):
            options.append((self.idm.accelerate(speed, top, ahead.gap, ahead.speed), f"{ahead.id} is ahead"))
        starts = self.may_start(moment, ego, met, waited)
        waits = f"it has waited for {waited:.0f} s and the zone is empty" if starts else ""
        before, precedences = self.yields_to(moment, ego, met, waits)
        for e, why in before:
            options.append((self._behind(e, self._line(e, met), moment, ego), f"{e.conflict.other} goes first: {why}"))
        # Of several that wish the same the first one counts, so that no vehicle is named that is not in the way.
        wished, why = min(options, key=lambda option: option[0])
        return wished, why, precedences

    def _line(self, e: Encounter, met: tuple[Encounter, ...]) -> float:
        """How far away a vehicle waits before a zone: not inside another crossing, where it would be in the way [m]."""
        line = e.own_way - self.stop_gap
        # From the last crossing to the first, since stepping back from one may lead into the one before.
        for other in sorted(met, key=lambda x: -x.own_way):
            if other.own_way > 0 and not other.merges() and other.own_way < line < other.conflict.exits[0]:
                line = other.own_way - self.stop_gap
        return line

    def _behind(self, e: Encounter, line: float, moment: Moment, ego: str) -> float:
        """The acceleration behind a vehicle that goes first: to follow its projection, or to stop before the zone."""
        speed = moment.scenes[ego].ego.speed
        waiting = inf if e.inside else self.idm.accelerate(speed, moment.forecast.model.top_speed, line, 0.0)
        if e.other_inside and not e.merges():
            return waiting if waiting < inf else -self.idm.hardest
        along = max(cos(crossing_angle(e.conflict, e.zone, moment.road_map)), 0.0)
        lead = e.own_way - e.its_way - 2 * FRONT - self.projection
        following = self.idm.accelerate(speed, moment.forecast.model.top_speed, lead, e.other.speed * along)
        return following if waiting == inf else max(following, waiting)


def mean_accelerations(
    forecast: Forecast, speed: float, target: float, where: tuple[str, float], window: float
) -> tuple[float, float, float]:
    """Return the mean acceleration that SLOWER, IDLE and FASTER lead to, each carried out once [m/s2]."""
    model = forecast.model
    steps = max(1, round(window / model.step))
    _, reached = rollout(model, [speed], [target], ONCE, steps, forecast.along(speed, where))
    slower, idle, faster = ((reached[0, :, -1] - speed) / (steps * model.step)).tolist()
    return slower, idle, faster


def closest_action(wished: float, means: tuple[float, float, float], hard: float) -> Action:
    """Return the action whose mean acceleration is closest to what is wished.

    Who wishes to brake hard slows down whatever the means are, and who wishes to accelerate never does; of two that
    are equally close, the slower one is taken.
    """
    if wished < -hard:
        return Action.SLOWER
    options = [(abs(mean - wished), k) for k, mean in enumerate(means) if k > 0 or wished < 0]
    return SPEED_ACTIONS[min(options)[1]]
