"""Who goes first, by what a vehicle on its own can tell: who is there first, and whoever cannot wait any more."""

from codriving.geometry.road_map import RoadMap
from codriving.methods.single_vehicle.encounters import Encounter, comes_from_the_right

OWN, OTHER = True, False


def goes_first(e: Encounter, road_map: RoadMap, tie: float) -> tuple[bool, str]:
    """Say whether a vehicle goes before another one, and why.

    Whoever is in the zone goes first; then whoever can no longer wait while the other one can; then whoever is there
    earlier by more than a tie. A tie is broken by right before left, and by the names of the two.

    Args:
        tie: Difference of the times to the zone up to which both count as there at once [s].

    Returns:
        Whether the ego vehicle goes first, and why it goes or does not.
    """
    c = e.conflict
    if e.inside != e.other_inside:
        return (OWN, "it is there already") if e.inside else (OTHER, f"{c.other} is there already")
    if e.inside:
        ahead = (e.zone.point_i - c.places[0], c.ego) <= (e.zone.point_j - c.places[1], c.other)
        return ahead, "both are there, and " + ("it is ahead" if ahead else f"{c.other} is ahead")
    if e.bound != e.other_bound:
        return (
            (OWN, "it cannot stop before it any more") if e.bound else (OTHER, f"{c.other} cannot be expected to stop")
        )
    earlier = c.ttcp[1] - c.ttcp[0]
    if abs(earlier) > tie:
        late = f"{abs(earlier):.1f} s"
        return (
            (OWN, f"it is there {late} before {c.other}")
            if earlier > 0
            else (OTHER, f"{c.other} is there {late} before")
        )
    right = comes_from_the_right(c, road_map)
    if right is not None:
        return (OTHER, f"{c.other} comes from the right") if right else (OWN, f"{c.other} comes from the left")
    return (c.ego < c.other), "both are there at once, and names decide"
