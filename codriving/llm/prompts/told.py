"""The variables that the prompts of the set ``informed`` print beyond those of ``planner``: what follows from what."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from math import inf, isfinite

from codriving.datatypes import (
    Action,
    ActionOutlook,
    Conflict,
    ExpectedPassage,
    HumanOutlook,
    Instance,
    Pair,
    PastDecision,
    Situation,
)
from codriving.llm.prompts.free_text import Names

# Where a time stands in the reason of an order, which is read later than it was written.
_BRACKETS = re.compile(r"\s*\([^()]*\d[^()]*\bs\b[^()]*\)")
_TIMES = re.compile(
    r"(?i)\s*\b(?:(?:in|at|after|by|within|until|from|of|for)\s+)?-?\d+(?:\.\d+)? ?(?:s|sec|seconds)\b(?: from now)?"
)

DELAY = 0.3  # What a vehicle loses by less is not told [s]

OPPOSED = {"you": "the right of way is yours", "it": "the right of way is its own", "": ""}


@dataclass(frozen=True, slots=True)
class MeetingView:
    """One vehicle that may get in the way of the CAV, and when it is there."""

    id: str
    driver: str
    relation: str
    enters: float
    leaves: float
    passed: bool  # Whether the CAV is past the entry of the zone
    inside: bool  # Whether the other vehicle is in the zone
    first: str  # Who goes first: ``you``, ``it``, or empty where that is open
    certain: bool


@dataclass(frozen=True, slots=True)
class HumanView(HumanOutlook):
    """The same with what was judged of the driver, and why; empty where only the rules of the road say."""

    judgement: str


@dataclass(frozen=True, slots=True)
class ArrivalView:
    """When the CAV is at the zone in which it meets another vehicle, after one action."""

    id: str
    time: float


@dataclass(frozen=True, slots=True)
class ChoiceView:
    """Actions of which a reader would be told the same."""

    names: tuple[str, ...]
    target: float | None
    safe: bool
    reasons: tuple[str, ...]
    arrivals: tuple[ArrivalView, ...]
    can_stop: bool  # Whether it can still stop before each of these zones, and that is known
    too_late: tuple[str, ...]  # Those before whose zones it can no longer stop
    follower: str
    braking: float
    waiting: tuple[str, ...]  # Those after the CAV that wait longer than after its fastest action
    delay: float


@dataclass(frozen=True, slots=True)
class PastView:
    """What the CAV decided last, and what has changed since."""

    action: str
    reason: str
    plan: str
    ago: int
    changes: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class BlockView:
    """A human driver in the way of CAVs that are to be ordered."""

    id: str
    speed: float
    blocks: tuple[tuple[str, float, float], ...]  # CAV, and from when to when it must not pass
    gives_way: tuple[str, ...]  # CAVs that it is expected to let pass


def timeless(reason: str) -> str:
    """Take the times out of a reason that may have been given a while ago."""
    if reason.startswith("own estimate"):
        return reason  # Made anew at each step
    return " ".join(_TIMES.sub("", _BRACKETS.sub("", reason)).replace(" ,", ",").split())


def near(situation: Situation, groups: Sequence[Sequence[int]]) -> list[Sequence[int]]:
    """Leave out CAVs that are in no zone within the horizon: a human driver may be there sooner than expected."""
    passages = situation.outlook.passages if situation.outlook is not None else ()
    humans = {n.id for n in situation.scene.neighbours if not n.is_cav}
    return [
        ks
        for ks in groups
        if situation.conflicts[ks[0]].other in humans
        or any(k >= len(passages) or isfinite(passages[k].enters) for k in ks)
    ]


def meetings(
    situation: Situation, groups: Sequence[Sequence[int]], names: Names, drivers: Mapping[str, str]
) -> list[MeetingView]:
    """Return one entry a vehicle in conflict: of several zones the most urgent one that lies ahead."""
    found, ego = [], situation.scene.ego.id
    passages = situation.outlook.passages if situation.outlook is not None else ()
    for ks in groups:
        k = next((k for k in ks if situation.conflicts[k].distances[0] > 0), ks[0])
        c = situation.conflicts[k]
        passage = passages[k] if k < len(passages) else ExpectedPassage(c.ttcp[1], inf)
        order = situation.order.first_of(ego, c.other)
        found.append(
            MeetingView(
                id=names(c.other),
                driver=drivers[c.other],
                relation=str(c.relation),
                enters=passage.enters,
                leaves=passage.leaves,
                passed=c.distances[0] <= 0,
                inside=c.distances[1] <= 0,
                first="" if order is None else "you" if order == ego else "it",
                certain=c.certain,
            )
        )
    return found


def humans(situation: Situation, names: Names, mentioned: set[str]) -> list[HumanView]:
    """Return the human drivers that are mentioned, with what was judged of them."""
    known: Sequence[HumanOutlook] = () if situation.outlook is None else situation.outlook.humans
    judged = {name: f"{j.answer}, since {j.reason}" for name, j in situation.judgements.items()}
    found = []
    for h in known:
        if h.id in mentioned:
            values = {field.name: getattr(h, field.name) for field in fields(h)}
            values |= {"id": names(h.id), "behind": names(h.behind) if h.behind else ""}
            values |= {"turns": tuple(dict.fromkeys(h.turns)), "judgement": names.sentence(judged.get(h.id, ""))}
            found.append(HumanView(**values))
    return found


def choices(situation: Situation, groups: Sequence[Sequence[int]], names: Names) -> list[ChoiceView]:
    """Put actions together of which a reader would be told the same."""
    outlook = situation.outlook
    by_action = {} if outlook is None else {a.action: a for a in outlook.actions}
    ahead = {k for ks in groups for k in ks if situation.conflicts[k].distances[0] > 0}
    lines: dict[tuple[object, ...], list[Action]] = {}
    for a in situation.assessments:
        seen = by_action.get(a.action)
        times = a.arrivals if seen is None else seen.arrivals
        known = [k for k in _first_ahead(groups, ahead) if a.safe and k < len(times)]
        arrivals = tuple(ArrivalView(names(situation.conflicts[k].other), round(times[k], 1)) for k in known)
        waiting, delay = _held_up(situation, by_action, a.action, ahead) if a.safe else ((), 0.0)
        braking = 0.0 if seen is None or not a.safe else round(seen.braking, 1)
        follower = names(seen.follower) if seen is not None and braking > 0 else ""
        each = [] if seen is None or not a.safe else [(k, seen.stops[k]) for k in _first_ahead(groups, ahead)]
        too_late = tuple(names(situation.conflicts[k].other) for k, stops in each if not stops)
        stops = bool(each) and not too_late
        told = (
            None if a.target is None else round(a.target, 1),
            a.safe,
            tuple(names.sentence(r) for r in a.reasons),
            arrivals,
            stops,
            too_late,
            follower,
            braking,
        )
        lines.setdefault((*told, tuple(map(names, waiting)), delay), []).append(a.action)
    return [ChoiceView(tuple(map(str, actions)), *told) for told, actions in lines.items()]  # type: ignore[arg-type]


def _first_ahead(groups: Sequence[Sequence[int]], ahead: set[int]) -> list[int]:
    """Return of each vehicle in conflict the most urgent zone that lies ahead."""
    return [k for ks in groups if (k := next((k for k in ks if k in ahead), -1)) >= 0]


def _held_up(
    situation: Situation, by_action: Mapping[Action, ActionOutlook], action: Action, ahead: set[int]
) -> tuple[tuple[str, ...], float]:
    """Return who waits longer than after the fastest safe action, and by how much the one that loses most [s]."""
    ego, found = situation.scene.ego.id, dict[str, float]()
    safe = [by_action[a.action] for a in situation.assessments if a.safe and a.action in by_action]
    for k in sorted(ahead):
        c: Conflict = situation.conflicts[k]
        if action in by_action and situation.order.first_of(ego, c.other) == ego:
            least, mine = min(a.arrivals[k] for a in safe), by_action[action].arrivals[k]
            lost = mine - least if isfinite(mine) else inf if isfinite(least) else 0.0
            found[c.other] = max(found.get(c.other, 0.0), lost)
    late = {name: lost for name, lost in found.items() if lost >= DELAY}
    return tuple(late), round(max(late.values(), default=0.0), 1)


def past_view(past: PastDecision | None, names: Names) -> PastView | None:
    """Return what is told of the last decision."""
    if past is None:
        return None
    changes = tuple(names.sentence(change) for change in past.changes)
    return PastView(str(past.action), names.sentence(past.reason), names.sentence(past.plan), past.ago, changes)


def waits(instance: Instance, one: str, other: str) -> tuple[float, float]:
    """Return how long the other of two vehicles waits if the one goes first, and the other way round [s].

    Of this pair alone: what others wait for is in the times of theirs.
    """
    first, second = instance.vehicles[one], instance.vehicles[other]

    def lost(pair: Pair, before: float, after: float) -> float:
        return max(max(before, 0.0) + instance.separation.get(pair, 0.0) - max(after, 0.0), 0.0)

    return lost((one, other), first.eta, second.eta), lost((other, one), second.eta, first.eta)


def blocks(
    passages: Mapping[str, Mapping[str, tuple[float, float]]], speeds: Mapping[str, float], names: Names
) -> list[BlockView]:
    """Return the human drivers in the way of CAVs, from their windows by CAV and driver [s]."""
    drivers = sorted({human for each in passages.values() for human in each})
    return [
        BlockView(
            id=names(human),
            speed=speeds.get(human, 0.0),
            blocks=tuple(
                (names(cav), max(each[human][0], 0.0), each[human][1])
                for cav, each in sorted(passages.items())
                if human in each and each[human][0] < inf and each[human][1] > 0
            ),
            gives_way=tuple(names(cav) for cav, each in sorted(passages.items()) if each.get(human, (0.0,))[0] == inf),
        )
        for human in drivers
    ]
