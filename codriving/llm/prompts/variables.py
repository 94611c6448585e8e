"""The variables of the prompts of CoDrivingLLM: to decide and to negotiate."""

from collections.abc import Iterator, Mapping, Sequence
from math import inf
from typing import Any

from codriving.datatypes import (
    Action,
    ActionAssessment,
    Conflict,
    Instance,
    LaneId,
    Memory,
    PassingOrder,
    PastDecision,
    Precedence,
    Role,
    SceneDescription,
    Situation,
    TrackedVehicle,
    Verdict,
)
from codriving.llm.prompts.free_text import LONGEST_MEMORY, Names, names_for
from codriving.llm.prompts.told import blocks, choices, humans, meetings, near, past_view, timeless, waits
from codriving.llm.prompts.views import (
    ActionView,
    ConflictView,
    EntrantView,
    FixedView,
    IntentView,
    LaneView,
    OrderView,
    OtherView,
    PairView,
    VehicleView,
)

DRIVERS = {"CAV": "CAV", "HDV": "human", None: "unknown driver"}  # Who drives, in words

OTHERS = 4  # Vehicles at most that are mentioned though it is not known which lane they are on


def decision_view(
    situation: Situation,
    nearest: int | None = None,
    with_memories: bool = True,
    past: PastDecision | None = None,
    thoughts: bool = False,
) -> dict[str, Any]:
    """Return the variables of the decision prompt.

    Args:
        nearest: Number of vehicles, nearest first, that are mentioned; None for all.
        past: What was decided last.
        thoughts: Whether the model is to write its thoughts down.
    """
    scene, names = situation.scene, names_for(situation)
    mentioned = {n.id for n in scene.by_distance()[:nearest]}
    neighbours = [n for n in scene.neighbours if n.id in mentioned]
    groups: dict[str, list[int]] = {}
    for k, c in enumerate(situation.conflicts):
        if c.other in mentioned:
            groups.setdefault(c.other, []).append(k)
    ego = scene.ego.id
    seen = {n.id for n in scene.neighbours}
    pairs = [p for p in situation.order.precedences if ego in (p.first, p.second)]
    pairs = [p for p in pairs if not seen & {p.first, p.second} - mentioned]
    drivers, each = {n.id: DRIVERS[n.kind] for n in scene.neighbours}, list(groups.values())
    outlook = situation.outlook
    reasons = {h.id: h.gives_way for h in outlook.humans} if outlook is not None else {}
    return {
        "ego": names(ego),
        "speed": scene.ego.speed,
        "lane": lane_name(scene.ego.lane),
        "route": scene.intent.route,
        "target_speed": scene.intent.target_speed,
        "between_lanes": bool(scene.covers),
        "must_change": None if scene.must_change is None else str(scene.must_change.action),
        "room": 0.0 if scene.must_change is None else scene.must_change.room,
        "lanes": lane_views(scene, neighbours, names),
        "others": _others(scene, neighbours, names),
        "conflict_lanes": [lane_name(lane) for lane in scene.conflict_lanes],
        "conflicts": [_conflict(situation, neighbours, ks, names) for ks in groups.values()],
        "intents": [
            IntentView(names(n.id), n.intent.route, n.intent.target_speed)
            for n in neighbours
            if n.intent is not None and n.role is not Role.OTHER
        ],
        "no_intents": [names(n.id) for n in neighbours if n.intent is None and n.role is not Role.OTHER],
        "binding": situation.order.binding,
        "before": [_ordered(p, p.first, names, "") for p in pairs if p.second == ego],
        "after": [_ordered(p, p.second, names, reasons.get(p.second, "")) for p in pairs if p.first == ego],
        "actions": _actions(situation.assessments, each, names),
        "meetings": meetings(situation, near(situation, each), names, drivers),
        "humans": humans(situation, names, mentioned),
        "choices": choices(situation, near(situation, each), names),
        "norms": [names.sentence(norm) for norm in outlook.norms] if outlook is not None else [],
        "past": past_view(past, names),
        "thoughts": thoughts,
        "may_hold": any(a.action is Action.HOLD for a in situation.assessments),
        "memories": memory_lines(situation.memories, names) if with_memories else [],
        "allowed": [str(action) for action in situation.allowed],
    }


def _ordered(p: Precedence, other: str, names: Names, held: str) -> OrderView:
    """Say who goes before or after the CAV; of the reasons for which a human driver gives way the one that held."""
    told = held or timeless(p.reason.partition(": it stands, or ")[0])
    return OrderView(names(other), names.sentence(p.reason), names.sentence(told))


def memory_lines(memories: Sequence[Memory], names: Names) -> list[str]:
    """Return what is told of memories: how alike each is, how often it was, and how often its action went well."""
    return [_remembered(m, [other for other in memories if other.action is m.action], names) for m in memories]


def _remembered(memory: Memory, same: Sequence[Memory], names: Names) -> str:
    times = "once" if memory.count == 1 else f"{memory.count} times"
    every, well = sum(m.count for m in same), sum(m.count for m in same if m.verdict is Verdict.EASED)
    went = f"; {memory.action} went well in {well} of {every} like cases" if every > 1 else ""
    return f"{names.sentence(memory.text, LONGEST_MEMORY)} ({memory.similarity:.0%} alike, {times}{went})"


def lane_name(lane: LaneId) -> str:
    """Return a lane as text, for instance ``a-b/1``."""
    start, end, index = lane
    return f"{start}-{end}/{index}"


def lane_views(scene: SceneDescription, neighbours: Sequence[TrackedVehicle], names: Names) -> list[LaneView]:
    """Return the ego lane and those beside it, each with the vehicles next ahead and next behind."""
    own = {n.role: VehicleView(names(n.id), DRIVERS[n.kind], n.gap or 0.0, n.speed) for n in neighbours}
    lanes = [LaneView("ego lane", own.get(Role.LEADING), own.get(Role.REARING))]
    known = {n.id: n for n in neighbours}
    for lane in scene.adjacent_lanes:
        there = {
            b.role: VehicleView(names(b.id), DRIVERS[known[b.id].kind], b.gap, known[b.id].speed)
            for b in scene.beside
            if b.lane == lane and b.id in known
        }
        side = "left lane" if lane[2] < scene.ego.lane[2] else "right lane"
        lanes.append(LaneView(side, there.get(Role.LEADING), there.get(Role.REARING)))
    return lanes


def _others(scene: SceneDescription, neighbours: Sequence[TrackedVehicle], names: Names) -> list[OtherView]:
    """List those nearest whose lane is not known."""
    unplaced = [n for n in scene.by_distance() if n in neighbours and n.lane is None and n.role is Role.OTHER]
    return [OtherView(names(n.id), DRIVERS[n.kind], *scene.offset(n), n.speed) for n in unplaced[:OTHERS]]


def _conflict(
    situation: Situation, neighbours: Sequence[TrackedVehicle], ks: Sequence[int], names: Names
) -> ConflictView:
    c: Conflict = situation.conflicts[ks[0]]
    n = next(n for n in neighbours if n.id == c.other)
    lane, free = "" if n.lane is None else lane_name(n.lane), max(situation.clear_times[k] for k in ks)
    way = (str(c.relation), *c.distances, *c.ttcp, c.dttcp, str(c.severity))
    return ConflictView(*way, names(n.id), DRIVERS[n.kind], lane, n.speed, len(ks), free, c.certain)


def _actions(
    assessments: Sequence[ActionAssessment], groups: Sequence[Sequence[int]], names: Names
) -> list[ActionView]:
    """Put actions together of which a reader would be told the same."""
    views: dict[tuple[object, ...], ActionView] = {}
    for a in assessments:
        times = a.arrivals
        arrivals = tuple(round(min((times[k] for k in ks if k < len(times)), default=inf), 1) for ks in groups)
        progress = None if a.progress is None else max(round(a.progress), 0)
        key = (a.safe, a.reasons, progress, arrivals, a.target)
        before = views[key].names if key in views else ()
        reasons = tuple(names.sentence(reason) for reason in a.reasons)
        views[key] = ActionView((*before, str(a.action)), a.safe, reasons, progress, arrivals, a.target)
    return list(views.values())


def negotiation_view(
    scenes: Mapping[str, SceneDescription],
    instance: Instance,
    pairs: Sequence[tuple[str, Conflict]],
    previous: PassingOrder | None,
    names: Names,
    binding: bool,
    passages: Mapping[str, Mapping[str, tuple[float, float]]] | None = None,
    thoughts: bool = False,
) -> dict[str, Any]:
    """Return the variables of the negotiation prompt.

    Args:
        passages: When each human driver may be in the way of each CAV, by CAV and driver [s].
        thoughts: Whether the model is to write its thoughts down.
    """
    asked = sorted({name for _, c in pairs for name in (c.ego, c.other)})
    ahead = {instance.vehicles[name].leader for name in asked} - {None}
    speeds = {n.id: n.speed for scene in scenes.values() for n in scene.neighbours}
    # That one drives behind the other is said of that vehicle.
    fixed = sorted(
        (first, second)
        for first, second in instance.before
        if {first, second} <= {*asked, *ahead} and instance.vehicles[second].leader != first
    )
    return {
        "vehicles": [_approaching(scenes, instance, name, names) for name in asked],
        "everyone": [_approaching(scenes, instance, name, names) for name in instance.vehicles],
        "humans": blocks(passages or {}, speeds, names),
        "pairs": (views := [_pair(name, c, instance, previous, names) for name, c in pairs]),
        "fixed": [FixedView(names(first), names(second)) for first, second in fixed],
        "binding": binding,
        "norms": list(_norms(views, instance, asked)),
        "thoughts": thoughts,
    }


def _norms(pairs: Sequence[PairView], instance: Instance, asked: Sequence[str]) -> Iterator[str]:
    """Give the rules of an order that apply to what is asked."""
    if any(not all(p.can_stop) for p in pairs):
        yield "who cannot stop before the zone any more goes first"
    if len({instance.vehicles[name].turning for name in asked}) > 1:
        yield "turning yields to going straight, but for one that is there 1 s earlier"
    if any(p.agreed for p in pairs):
        yield "what was agreed is changed only to save more than 1 s"
    if len(pairs) > 2:
        yield "never in a circle: if A goes before B and B before C, C does not go before A"


def _approaching(scenes: Mapping[str, SceneDescription], instance: Instance, name: str, names: Names) -> EntrantView:
    entrant, scene = instance.vehicles[name], scenes[name]
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


def _pair(name: str, c: Conflict, instance: Instance, previous: PassingOrder | None, names: Names) -> PairView:
    agreed = None if previous is None else previous.first_of(c.ego, c.other)
    first = "" if agreed is None else names(agreed)
    ego, other, relation, severity = names(c.ego), names(c.other), str(c.relation), str(c.severity)
    one, two = instance.approach(c.ego, c.other), instance.approach(c.other, c.ego)
    earliest, can_stop = (max(one.earliest, 0.0), max(two.earliest, 0.0)), (one.can_stop, two.can_stop)
    distances, lost = (one.distance, two.distance), waits(instance, c.ego, c.other)
    return PairView(name, ego, other, relation, distances, c.ttcp, c.dttcp, severity, first, earliest, can_stop, lost)
