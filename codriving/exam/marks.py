"""What the answers to an exam are worth, counted."""

from collections import Counter
from collections.abc import Mapping, Sequence

from codriving.exam.sitting import Answered
from codriving.exam.stored import ExamSituation

SAME = 0.001  # An action is the best if it loses less than this against it [s]


def mark(times: Sequence[Sequence[Answered]]) -> Mapping[str, float]:
    """Count what was answered the first time, and how often it was the same at later times.

    A question without an answer that can be used counts with the others, and never as answered rightly; a driver who is
    taken to be as likely to go as to let pass is left out.
    """
    counts = Counter[str]()
    for answered in times[0]:
        counts.update(_of(answered))
        counts.update({f"model {name}": number for name, number in answered.counts.items()})
        counts.update({f"form {call['form']}": 1 for line in answered.lines for call in line["calls"][-1:]})
        for line in answered.lines:
            good = line["value"] is not None and not line["mended"] and len(line["calls"]) - line["shortened"] <= 1
            counts.update(asked=1, in_form=good, unusable=line["value"] is None)
    for later in times[1:]:
        pairs = list(zip(times[0], later, strict=True))
        counts.update(again=len(pairs), same=sum(one.decided == other.decided for one, other in pairs))
    return {**dict.fromkeys(("asked", "again"), 0), **counts, "questions": len(times[0])}


def _of(answered: Answered) -> Mapping[str, int]:
    """Count one answer."""
    asked = answered.asked
    if not isinstance(asked, ExamSituation):
        said = [
            pair.consequence(first) for pair in asked.pairs if (first := answered.first.get((pair.one, pair.other)))
        ]
        return {"pairs": len(asked.pairs), "pairs_acceptable": sum(one.acceptable for one in said)}
    found = None if answered.action is None else asked.actions[answered.action]
    best = found is not None and found.acceptable and found.loss - asked.actions[asked.best].loss < SAME
    told = zip(answered.yields, asked.yields, strict=True) if answered.yields else ()
    known = [(one, truth) for one, truth in told if one is not None]
    return {
        "situations": 1,
        "safe": int(found is not None and found.safe),
        "acceptable": int(found is not None and found.acceptable),
        "best": int(best),
        "drivers": len(known),
        "drivers_right": sum(one is truth for one, truth in known),
    }
