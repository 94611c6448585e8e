"""Third layer: no action may intensify a conflict with a vehicle of a conflict lane (Section III-C.4)."""

from collections.abc import Sequence

import numpy as np

from codriving.datatypes import Action, Conflict, Relation, TrackedVehicle
from codriving.geometry import (
    TRUE,
    Array,
    ConflictZone,
    Flags,
    Footprint,
    first_overlap,
    reacts,
    stays_ahead,
    stays_behind,
)
from codriving.reasoning.exits import full_exit, gets_out
from codriving.reasoning.safety.safety_input import SafetyInput

PAD = 0.5  # Room along the route beyond the planning footprint [m]

BODY = Footprint(5.2, 2.3)  # A vehicle's body with the room for cutting a corner, beside a vehicle that gives way [m]

BOUND_LAG = 0.4  # Time between the least that the other vehicle can do and the CAV's entering [s]

AHEAD_LAG = 0.4  # Time between the CAV's leaving and the earliest moment at which the other vehicle can be there [s]


def check_conflicts(given: SafetyInput) -> dict[Action, list[str]]:
    """Remove actions after which the CAV could neither stop before a zone that is not its turn, nor pass it in time."""
    found: dict[Action, list[str]] = {}
    conflicts = [c for c in given.conflicts if not changes_before(given, c)]
    passes = []
    for c in conflicts:
        goes, stops = passes_and_stops(given, c)
        passes.append(goes)
        for action, fine in zip(given.actions, goes | stops, strict=True):
            if not fine:
                add(found, action, f"{action} intensifies the {c.relation} conflict with {c.other} ({c.severity})")
    # A CAV that waits for this one is only delayed; a human driver in between may never get out of a gridlock. Where
    # ways merge no vehicle is caught in between.
    for c in (c for c in conflicts if c.relation is Relation.CROSSING and not given.vehicles[c.other].is_cav):
        zone = given.road_map.zones(*c.routes)[c.zone]
        inside = [given.scene.place < zone.entry_i < end < zone.exit_i for end in (given.stops[:, -1] + PAD).tolist()]
        if not any(inside) or leaves_in_time(given, c, zone):
            continue
        through = gets_through(given, conflicts, passes)
        for k, action in enumerate(given.actions):
            if inside[k] and not through[k]:
                add(found, action, f"after {action} the CAV might have to stop in the way of {c.other}")
    return found


def check_exit(given: SafetyInput) -> dict[Action, list[str]]:
    """Remove actions after which the CAV could not stop before a junction past which there is no room for it."""
    full = full_exit(given.moment, given.vehicles, given.vehicles[given.ego])
    if full is None:
        return {}
    why = f"exit: {full[0]} stands past the junction and leaves no room there"
    return {a: [why] for a, stop in zip(given.actions, given.stops[:, -1].tolist(), strict=True) if stop >= full[1]}


def gets_through(given: SafetyInput, conflicts: Sequence[Conflict], passes: Sequence[Flags]) -> Flags:
    """Whether the CAV can pass, or comes behind a vehicle that moves as expected, in each of its conflicts."""
    through: Flags = np.ones(len(given.actions), dtype=np.bool_)
    for c, goes in zip(conflicts, passes, strict=True):
        if not goes.all():
            through &= goes | expected_to_pass(given, c)
    return through


def changes_before(given: SafetyInput, c: Conflict) -> bool:
    """Whether one of two CAVs comes to a zone only by a lane change not yet begun, which its second layer guards."""
    for k, is_cav in enumerate((True, given.vehicles[c.other].is_cav)):
        change = given.road_map.changes.ahead(c.routes[k], c.places[k]) if is_cav else None
        if change is not None and c.places[k] + c.exits[k] > change[1]:
            return True
    return False


def expected_to_pass(given: SafetyInput, c: Conflict) -> Flags:
    """Whether the CAV comes behind the other vehicle if that one moves as expected."""
    for motion in given.expected[c.other]:
        if motion.route == c.routes[1]:
            return stays_behind(given.road_map.zones(*c.routes)[c.zone], given.goes, motion.places, 0, PAD)
    return np.zeros(len(given.actions), dtype=np.bool_)


def leaves_in_time(given: SafetyInput, c: Conflict, zone: ConflictZone) -> bool:
    """Whether the CAV, as it is expected to move, will be out of a zone before a human driver can be there."""
    way = (c.routes[1], c.places[1])
    most = c.places[1] + given.forecast.reach_of(given.vehicles[c.other], way).most
    return bool(stays_ahead(zone, given.expected[c.ego][0].places[None], most, 0, 0.0)[0])


def add(found: dict[Action, list[str]], action: Action, reason: str) -> None:
    """Note a reason once."""
    reasons = found.setdefault(action, [])
    if f"conflict lane: {reason}" not in reasons:
        reasons.append(f"conflict lane: {reason}")


def passes_and_stops(given: SafetyInput, c: Conflict) -> tuple[Flags, Flags]:
    """Judge every action in one conflict: can the CAV then pass, and can it then stop?

    It can pass if it comes behind whatever the other one does at the least, or ahead of the earliest moment at which
    the other one can be there; it can stop if braking keeps it out of the way. A vehicle that gives way need not be
    feared as long as the bodies keep clear when it brakes.
    """
    zone, other = given.road_map.zones(*c.routes)[c.zone], given.vehicles[c.other]
    place = c.places[1]
    reach = given.forecast.reach_of(other, other.routes[0] if other.is_cav else (c.routes[1], place))
    relied_on = _goes_on(given, other)
    # A bound on what the other one can do is a margin in itself; an expectation needs one.
    lag = given.lag if relied_on else round(BOUND_LAG / given.forecast.sample)
    # Both in one go: nearly all of the time goes into calls, not into numbers.
    motions = np.concatenate((given.goes, given.stops))
    slowly = reach.steady - (0.0 if other.told is None else other.told.behind) if relied_on else reach.least
    fine = stays_behind(zone, motions, place + slowly, lag, PAD)
    goes_first = given.order.first_of(c.ego, c.other) == c.ego
    if goes_first and (other.is_cav or given.moment.gives_way(c, other, given.road_map)):
        fine |= keeps_clear(given, c, motions, place + reach.least)
    if gets_out(given.moment, given.vehicles[c.ego], other, goes_first):
        fine[:] = True
    goes, stops = fine[: len(given.goes)], fine[len(given.goes) :]
    if (goes_first or not (given.order.binding and other.is_cav)) and c.distances[1] > 0:
        late = np.flatnonzero(~goes)
        if len(late):
            most, after = place + reach.most, given.goes[late]
            reacting = reacts(zone, after, most, given.forecast.sample)
            goes[late] = stays_ahead(zone, after, reacting, round(AHEAD_LAG / given.forecast.sample), PAD)
    return goes, stops


def keeps_clear(given: SafetyInput, c: Conflict, motions: Array, other: Array) -> Flags:
    """Whether the CAV and another vehicle that gives way would not touch, the bodies a little larger than they are."""
    for footprint in (BODY, TRUE):
        overlaps = [first_overlap(z, motions, other) for z in given.road_map.zones(*c.routes, footprint)]
        if not any(steps[0] == 0 for steps in overlaps):
            clear: Flags = np.ones(len(motions), dtype=np.bool_)
            for steps in overlaps:
                clear &= steps == motions.shape[1]
            return clear
    return np.zeros(len(motions), dtype=np.bool_)


def _goes_on(given: SafetyInput, other: TrackedVehicle) -> bool:
    """Whether a CAV can be relied on to go on: it waits for no vehicle and has said that it wants to keep its speed."""
    expected = given.expected.get(other.id, ())
    return other.is_cav and bool(expected) and expected[0].free and other.target >= other.speed - 0.5
