"""What each CAV decided last, so that it can be told so, and what has changed since."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from codriving.datatypes import Decision, PastDecision, Situation

FORGOTTEN = 8  # Decisions after which nothing is said of the last one that was asked for

MOST = 4  # Changes that are told at most

FASTER_BY = 1.5  # Change of a speed that is worth telling [m/s]


@dataclass(frozen=True, slots=True)
class _Then:
    step: int
    told: PastDecision
    allowed: frozenset[str]
    before: frozenset[str]  # Who went before the CAV
    speed: float


class PastDecisions:
    """The last decisions of one episode that were asked for, by CAV."""

    def __init__(self) -> None:
        self._step = 0
        self._last: dict[str, _Then] = {}

    def begin_step(self) -> None:
        """Begin the next decision step."""
        self._step += 1

    def note(self, situation: Situation, decision: Decision, plan: str) -> None:
        """Keep a decision that was asked for."""
        told = PastDecision(decision.action, decision.reason, plan, 0, (), _speeds(situation))
        allowed = frozenset(str(a) for a in situation.allowed)
        then = _Then(self._step, told, allowed, _before(situation), situation.scene.ego.speed)
        self._last[decision.ego] = then

    def of(self, situation: Situation) -> PastDecision | None:
        """Return what a CAV decided last, and what has changed since; None if that is long ago."""
        then = self._last.get(situation.scene.ego.id)
        if then is None or not 0 < self._step - then.step <= FORGOTTEN:
            return None
        changes = tuple(_changes(then, situation))[:MOST]
        return replace(then.told, ago=self._step - then.step, changes=changes)


def _speeds(situation: Situation) -> Mapping[str, float]:
    others = dict.fromkeys(c.other for c in situation.conflicts)
    return {n.id: n.speed for n in situation.scene.neighbours if n.id in others}


def _before(situation: Situation) -> frozenset[str]:
    return frozenset(p.first for p in situation.order.precedences if p.second == situation.scene.ego.id)


def _changes(then: _Then, now: Situation) -> Iterator[str]:
    was, is_ = then.told.speeds, _speeds(now)
    before, present = _before(now), {n.id for n in now.scene.neighbours}
    for name in sorted(was.keys() & is_.keys()):
        if abs(is_[name] - was[name]) >= FASTER_BY:
            word = "slowed down" if is_[name] < was[name] else "sped up"
            yield f"{name} {word} from {was[name]:.1f} to {is_[name]:.1f} m/s"
    for name in sorted((before ^ then.before) & present):
        yield f"{name} now goes before you" if name in before else f"{name} no longer goes before you"
    for name in sorted(is_.keys() - was.keys() - before):
        yield f"{name} is in conflict with you now"
    for name in sorted(was.keys() - is_.keys()):
        yield f"{name} is no longer in conflict with you"
    lost = sorted(then.allowed - {str(a) for a in now.allowed})
    if lost:
        yield f"{', '.join(lost)} can no longer be chosen"
    if abs(now.scene.ego.speed - then.speed) >= FASTER_BY:
        yield f"your speed went from {then.speed:.1f} to {now.scene.ego.speed:.1f} m/s"
