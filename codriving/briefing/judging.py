"""When there is nothing to judge, so that a model need not be asked: the rules drive on."""

from codriving.datatypes import Situation

ALIKE = 3.0  # Actions are alike if what they gain within the horizon differs by less than this [m]


def nothing_to_judge(situation: Situation) -> bool:
    """Whether a CAV has nothing to weigh.

    That is so

    - if one action is allowed;
    - if it is past the entry of each zone in which it is in conflict: it leaves them, and leaves them to the others;
    - if the allowed actions are alike, and it has no zone ahead that a human driver may come to.

    Where its route asks for a lane change only the first holds.
    """
    scene = situation.scene
    if len(situation.allowed) < 2:
        return True
    if scene.must_change is not None:
        return False
    ahead = [c for c in situation.conflicts if c.distances[0] > 0 and c.exits[1] > 0]
    if situation.conflicts and not ahead:
        return True
    humans = {n.id for n in scene.neighbours if not n.is_cav}
    gains = [a.progress for a in situation.assessments if a.safe]
    if None in gains or any(c.other in humans for c in ahead):
        return False
    known = [gain for gain in gains if gain is not None]
    return max(known) - min(known) < ALIKE
