"""A situation as it is remembered: the same facts that a decider gets, without a name, a place or a route."""

from math import isfinite

from codriving.datatypes import Action, Description, Role, SceneDescription, Situation

DRIVERS = {"CAV": "CAV", "HDV": "human", None: "unknown"}


def describe(situation: Situation) -> Description:
    """Describe a situation in words, and by the numbers and kinds that the words are made of."""
    numbers: dict[str, float] = {}
    kinds: dict[str, str] = {}
    # In this order, which is that of the numbers and kinds in a file.
    scene, conflict, order = (part(situation, numbers, kinds) for part in (_scene, _conflict, _order))
    return Description(scene, conflict, order, {name: round(x, 3) for name, x in numbers.items()}, kinds)


def _scene(situation: Situation, numbers: dict[str, float], kinds: dict[str, str]) -> str:
    """The CAV itself, and the vehicles next to it on its lane and on others."""
    scene, ego, target = situation.scene, situation.scene.ego, situation.scene.intent.target_speed
    numbers["speed"], numbers["target"] = ego.speed, target
    words = [f"Driving {ego.speed:.1f} m/s, target {target:.1f} m/s"]
    for role, name, where in ((Role.LEADING, "lead", "ahead"), (Role.REARING, "rear", "behind")):
        other = scene.next_in(role)
        if other is None or other.gap is None:
            words.append(f"no vehicle {where} on the lane")
            continue
        numbers[f"{name}_gap"], numbers[f"{name}_speed"] = max(other.gap, 0.0), other.speed
        words.append(f"a vehicle {other.gap:.0f} m {where} on the lane at {other.speed:.1f} m/s")
    if scene.must_change is not None:
        numbers["room"] = scene.must_change.room
        words.append(f"the lane has to be changed within {scene.must_change.room:.0f} m")
    words += _beside(scene, numbers) + _nearest(scene, numbers)
    kinds["allowed"] = " ".join(sorted(str(action) for action in situation.allowed))
    return "; ".join([*words, f"allowed: {kinds['allowed']}"]) + "."


def _beside(scene: SceneDescription, numbers: dict[str, float]) -> list[str]:
    """The vehicles next ahead and next behind on the lanes beside, where lanes are known."""
    words = []
    for lane in scene.adjacent_lanes:
        side = "left" if lane[2] < scene.ego.lane[2] else "right"
        numbers[f"{side}_lane"] = 1.0
        gaps = {
            "ahead" if b.role is Role.LEADING else "behind": (b.gap, n.speed)
            for b in scene.beside
            if b.lane == lane and (n := scene.neighbour(b.id)) is not None
        }
        for where, (gap, speed) in sorted(gaps.items()):
            numbers[f"{side}_{where}"], numbers[f"{side}_{where}_speed"] = gap, speed
            words.append(f"on the {side} lane a vehicle {gap:.0f} m {where} at {speed:.1f} m/s")
        if not gaps:
            words.append(f"the {side} lane is empty")
    return words


def _nearest(scene: SceneDescription, numbers: dict[str, float]) -> list[str]:
    """The nearest of all vehicles ahead but the leader: all that is seen where no conflicts are."""
    nearest = next((n for n in scene.by_distance() if n.role is not Role.LEADING and scene.offset(n)[0] > 0), None)
    if nearest is None:
        return []
    far, right = numbers["near_ahead"], numbers["near_right"] = scene.offset(nearest)
    numbers["near_speed"] = nearest.speed
    where = f"{far:.0f} m ahead and {abs(right):.0f} m to the {'right' if right > 0 else 'left'}"
    return [f"the nearest other vehicle {where} at {nearest.speed:.1f} m/s"]


def _conflict(situation: Situation, numbers: dict[str, float], kinds: dict[str, str]) -> str:
    """The most urgent conflict, and how many more there are."""
    if not situation.conflicts:
        kinds["relation"] = kinds["severity"] = "none"
        return "No conflict."
    c = situation.conflicts[0]
    other = situation.scene.neighbour(c.other)
    kinds["relation"], kinds["severity"] = str(c.relation), str(c.severity)
    kinds["driver"] = DRIVERS[None if other is None else other.kind]
    mine, its = c.ttcp
    numbers.update(mine=c.distances[0], its=c.distances[1], my_ttcp=mine, its_ttcp=its, later=mine - its)
    numbers["dttcp"], numbers["conflicts"] = c.dttcp, len({k.other for k in situation.conflicts})
    if other is not None:
        numbers["its_speed"] = other.speed
    if isfinite(situation.clear_times[0]):
        numbers["free"] = situation.clear_times[0]
    more = int(numbers["conflicts"]) - 1
    speed = f" at {numbers['its_speed']:.1f} m/s" if "its_speed" in numbers else ""
    return (
        f"{str(c.relation).capitalize()} conflict with a {kinds['driver']} vehicle: it is {c.distances[1]:.0f} m "
        f"away{speed}, TTCP {c.ttcp[1]:.1f} s; the CAV is {c.distances[0]:.0f} m away, TTCP {c.ttcp[0]:.1f} s; "
        f"dTTCP {c.dttcp:.1f} s, {c.severity}" + (f"; conflicts with {more} more" if more else "") + "."
    )


def _order(situation: Situation, numbers: dict[str, float], kinds: dict[str, str]) -> str:
    """Which vehicle goes first in the most urgent conflict, and how many go before the CAV altogether."""
    ego = situation.scene.ego.id
    before = {p.first for p in situation.order.precedences if p.second == ego}
    numbers["before"] = len(before)
    first = situation.order.first_of(ego, situation.conflicts[0].other) if situation.conflicts else None
    kinds["order"] = "none" if first is None else "first" if first == ego else "second"
    if first is None:
        return f"Nothing was agreed; {len(before)} go before the CAV." if before else "Nothing was agreed."
    return f"The CAV goes {kinds['order']}; {len(before)} go before it."


def brief(description: Description, action: Action) -> str:
    """Say in one line what a situation was and what was done, short enough for a prompt."""
    return f"{met(description)}: {action}."


def met(description: Description) -> str:
    """Say in one line what a situation was, in words that need no explanation."""
    n, k = description.numbers, description.kinds
    if k["relation"] == "none":
        lead = f", {n['lead_gap']:.0f} m behind {n['lead_speed']:.1f} m/s" if "lead_gap" in n else ""
        return f"At {n['speed']:.1f} m/s, no conflict{lead}"
    order = {"first": "first", "second": "second", "none": "not ordered"}[k["order"]]
    return (
        f"At {n['speed']:.1f} m/s, {k['relation']} with {k['driver']}, {n['mine']:.0f} m and {n['my_ttcp']:.1f} s "
        f"before the zone, it {n['its']:.0f} m and {n['its_ttcp']:.1f} s, {order}"
    )
