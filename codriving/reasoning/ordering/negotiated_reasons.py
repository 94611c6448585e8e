"""Why somebody goes first, in words."""

from codriving.datatypes.ordering_problem import Entrant


def reason_between(first: Entrant, second: Entrant) -> str:
    """Explain the order of two CAVs."""
    if first.committed and not second.committed:
        return f"{first.id} can no longer stop before the conflict zone"
    if second.leader == first.id:
        return f"{first.id} drives ahead of {second.id} on the same lane"
    if second.turning and not first.turning and first.eta > second.eta - 2.0:
        return f"{second.id} turns and yields to {first.id}, which goes straight"
    if first.eta <= second.eta:
        return f"{first.id} can be there earlier ({first.eta:.1f} s against {second.eta:.1f} s)"
    return f"{first.id} goes first so that the others have to wait less"


def reason_human(human_first: bool, begin: float, end: float, time: float) -> str:
    """Explain the order of a CAV and a human driver.

    Args:
        begin: Time from which the CAV could no longer pass in front [s].
        end: Time from which the CAV can pass behind [s].
        time: When the CAV will pass [s].
    """
    if human_first:
        return f"a human driver shares no intent and may use the zone until {end:.1f} s from now"
    if begin == float("inf"):
        return "the human driver gives way: it stands, or the CAV has the right of way or is in the junction already"
    return f"the CAV is through ({time:.1f} s) before the human driver can be there"
