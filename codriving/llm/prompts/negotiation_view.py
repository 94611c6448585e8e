"""The variables of the negotiation prompt: the CAVs whose order is open, and the pairs to be ordered."""

from collections.abc import Mapping, Sequence
from typing import Any

from codriving.datatypes.conflict import Conflict
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.ordering_problem import Instance, Pair
from codriving.datatypes.scene_description import SceneDescription
from codriving.llm.prompts.free_text import Names
from codriving.llm.prompts.views import EntrantView, FixedView, PairView


def negotiation_view(
    scenes: Mapping[str, SceneDescription],
    instance: Instance,
    pairs: Sequence[tuple[str, Conflict]],
    previous: PassingOrder | None,
    names: Names,
    binding: bool,
) -> dict[str, Any]:
    """Return the variables of the negotiation prompt."""
    asked = sorted({name for _, c in pairs for name in (c.ego, c.other)})
    ahead = {instance.entrants[name].leader for name in asked} - {None}
    fixed = sorted(pair for pair in instance.before if set(pair) <= {*asked, *ahead} and not _follows(instance, pair))
    return {
        "vehicles": [_entrant(scenes, instance, name, names) for name in asked],
        "pairs": [_pair(name, c, previous, names) for name, c in pairs],
        "fixed": [FixedView(names(first), names(second)) for first, second in fixed],
        "binding": binding,
    }


def _follows(instance: Instance, pair: Pair) -> bool:
    """Whether a pair is fixed because one drives behind the other, which is said of that vehicle."""
    return instance.entrants[pair[1]].leader == pair[0]


def _entrant(scenes: Mapping[str, SceneDescription], instance: Instance, name: str, names: Names) -> EntrantView:
    entrant, scene = instance.entrants[name], scenes[name]
    windows = {(max(begin, 0.0), end) for begin, end in entrant.windows if begin < float("inf") and end > 0}
    return EntrantView(
        id=names(name),
        speed=entrant.speed,
        route=scene.intent.route,
        turns=entrant.turning,
        target_speed=scene.intent.target_speed,
        distance=entrant.distance,
        earliest=max(entrant.eta, 0.0),
        can_stop=not entrant.committed,
        behind="" if entrant.leader is None else names(entrant.leader),
        blocked=_joined(sorted(windows)),
    )


def _joined(windows: Sequence[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Put windows together that overlap."""
    joined: list[tuple[float, float]] = []
    for begin, end in windows:
        if joined and begin <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        else:
            joined.append((begin, end))
    return tuple(joined)


def _pair(name: str, c: Conflict, previous: PassingOrder | None, names: Names) -> PairView:
    agreed = None if previous is None else previous.first_of(c.ego, c.other)
    return PairView(
        name=name,
        one=names(c.ego),
        other=names(c.other),
        relation=str(c.relation),
        distances=c.distances,
        ttcp=c.ttcp,
        dttcp=c.dttcp,
        severity=str(c.severity),
        agreed="" if agreed is None else names(agreed),
    )
