"""What a decision of a vehicle on its own rests on, in the form in which every method's decisions are recorded."""

from codriving.datatypes.action import Action
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.situation import ActionAssessment, Situation
from codriving.methods.single_vehicle.protocol import Choice, View
from codriving.reasoning.severity import SLOWEST


def account(view: View, choice: Choice) -> Situation:
    """Write down what a decision rests on."""
    name = view.scene.ego.id
    speeds = {n.id: n.speed for n in view.scene.neighbours}
    before = [p.first for p in choice.precedences if p.second == name]
    after = [p.second for p in choice.precedences if p.first == name]
    sequence = (*before, name, *after) if choice.precedences else ()
    return Situation(
        scene=view.scene,
        conflicts=view.conflicts,
        order=PassingOrder(sequence, choice.precedences),
        clear_times=tuple(
            max(c.exits[1], 0.0) / max(speeds[c.other], SLOWEST) if c.other in before else 0.0 for c in view.conflicts
        ),
        assessments=tuple(_assessment(action, choice) for action in view.actions),
    )


def _assessment(action: Action, choice: Choice) -> ActionAssessment:
    why = choice.refused.get(action, "")
    return ActionAssessment(action, not why, (why,) if why else (), (), None)
