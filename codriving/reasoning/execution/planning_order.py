"""In which order everybody is planned: the passing order, and nobody before those who drive ahead on the same way."""

from collections.abc import Mapping, Sequence

from codriving.datatypes.action import Action
from codriving.datatypes.scene_description import TrackedVehicle
from codriving.reasoning.conflicts import is_open
from codriving.reasoning.execution.stage import Stage
from codriving.reasoning.prediction.expectation import is_behind

LANE_CHANGES = frozenset((Action.LANE_LEFT, Action.LANE_RIGHT))

BODY = 5.0
"""Length of a vehicle [m]."""


def cavs(stage: Stage) -> dict[str, TrackedVehicle]:
    """Return all CAVs, each as it knows itself."""
    return {name: known[name] for name, known in sorted(stage.known.items())}


def drives_ahead(stage: Stage, vehicles: Mapping[str, TrackedVehicle]) -> set[tuple[str, str]]:
    """Return the pairs of CAVs (ahead, behind) that follow one another, whatever the order says."""
    found = set()
    for behind in vehicles.values():
        for ahead in vehicles.values():
            if ahead.id == behind.id:
                continue
            for route, place in behind.routes:
                for other, there in ahead.routes:
                    zones = stage.road_map.zones(route, other)
                    if any(is_behind(zone, place, there) for zone in zones):
                        found.add((ahead.id, behind.id))
            if _is_alongside(stage, behind, ahead):
                found.add((ahead.id, behind.id))
    return found


def _is_alongside(stage: Stage, changing: TrackedVehicle, other: TrackedVehicle) -> bool:
    """Whether somebody drives ahead or alongside on the lane that a CAV must change to, which then cannot go first."""
    change = stage.scenes[changing.id].must_change
    if change is None or not LANE_CHANGES & set(stage.available[changing.id]):
        return False
    (route, place), (way, there) = changing.routes[0], other.routes[0]
    if stage.scenes[other.id].ego.lane != change.lane:
        return False
    for zone in stage.road_map.zones(route, way):
        if zone.merge_i is not None and zone.merge_j is not None and is_open(zone, place, there):
            return zone.merge_j - there < zone.merge_i - place + BODY
    return False


def planning_order(
    sequence: Sequence[str], vehicles: Mapping[str, TrackedVehicle], ahead: set[tuple[str, str]]
) -> list[str]:
    """Line all CAVs up for planning."""
    rank = {name: i for i, name in enumerate(sequence)}
    leaders: dict[str, list[str]] = {}
    for leader, follower in sorted(ahead):
        leaders.setdefault(follower, []).append(leader)
    order: list[str] = []
    entered: set[str] = set()

    def place(name: str) -> None:
        # Whoever drives ahead is drawn forward; a circle, as only an overlap makes one, is cut where it closes.
        if name not in entered:
            entered.add(name)
            for leader in leaders.get(name, ()):
                place(leader)
            order.append(name)

    for name in sorted(vehicles, key=lambda n: (rank.get(n, len(rank)), -vehicles[n].routes[0][1], n)):
        place(name)
    return order
