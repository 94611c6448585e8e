"""Decisions that take time to think of: meanwhile a reflex drives, within what the safety check allows."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from codriving.datatypes import Action, Decision, Situation
from codriving.reasoning import Decider
from codriving.wrappers.delays import EARLY, Asked, Delays

# What the reflex does, the first that is allowed: where no action is safe only the least dangerous one is.
REFLEXES = (Action.IDLE, Action.SLOWER, Action.HOLD, Action.FASTER, Action.LANE_RIGHT, Action.LANE_LEFT)


@dataclass(frozen=True, slots=True)
class DecisionThought:
    """A decision, and when it was asked for."""

    begun: float  # [s]
    due: float  # [s]
    decision: Decision


class LateAnswers:
    """The decisions that are being thought of, one a CAV at most."""

    def __init__(self, counts: Counter[str]) -> None:
        self._counts = counts
        self._thoughts: dict[str, DecisionThought] = {}

    def arrived(self, now: float, names: Sequence[str]) -> dict[str, DecisionThought]:
        """Return the decisions that are ready, by CAV; those of CAVs that have left are forgotten."""
        left = {name: thought for name, thought in self._thoughts.items() if name in names}
        ready = {name: thought for name, thought in left.items() if thought.due <= now + EARLY}
        self._thoughts = {name: thought for name, thought in left.items() if name not in ready}
        return ready

    def thinks(self, name: str) -> bool:
        """Whether a CAV is thinking."""
        return name in self._thoughts

    def begin(self, now: float, seconds: float, decision: Decision) -> Decision | None:
        """Begin to think of a decision, which takes some time [s]; return one that takes none."""
        if seconds <= 0:
            return decision
        self._thoughts[decision.ego] = DecisionThought(now, now + seconds, decision)
        return None

    def driven(self, ego: str, now: float, thought: DecisionThought | None, allowed: Sequence[Action]) -> Decision:
        """Return what a CAV does that has no answer about the present, and count what became of the late one."""
        if thought is not None and thought.decision.action in allowed:
            self._counts["late_decisions"] += 1
            made = thought.decision
            return replace(made, reason=f"thought of {now - thought.begun:.1f} s ago: {made.reason}")
        self._counts["reflexes"] += 1
        action = reflex(allowed)
        if thought is None:
            return Decision(ego, action, f"{action} by reflex, while it thinks")
        self._counts["dropped_decisions"] += 1
        wanted = f"{thought.decision.action}, thought of {now - thought.begun:.1f} s ago, is not allowed any more"
        return Decision(ego, action, f"{action} by reflex: {wanted}")


def reflex(allowed: Sequence[Action]) -> Action:
    """Return what is done without thinking."""
    return next(action for action in REFLEXES if action in allowed)


class LateDecider(Decider):
    """What decides in ``codriving``, each CAV with a mind of its own: while one thinks it begins no new thought."""

    def __init__(self, decider: Decider, delays: Delays, asked: Callable[[], Asked], counts: Counter[str]) -> None:
        self.decider, self._delays, self._asked = decider, delays, asked
        self._answers = LateAnswers(counts)
        self.now = 0.0  # Simulated time of the step [s]

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order."""
        arrived = self._answers.arrived(self.now, [s.scene.ego.id for s in situations])
        free = [s for s in situations if not self._answers.thinks(s.scene.ego.id)]
        made = self.decider.decide(free) if free else []
        asked = self._asked()
        begun = {d.ego: self._answers.begin(self.now, self._delays.of_mind(asked, d.ego), d) for d in made}
        named = [(s.scene.ego.id, s.allowed) for s in situations]
        return [begun.get(ego) or self._answers.driven(ego, self.now, arrived.get(ego), left) for ego, left in named]
