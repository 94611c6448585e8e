"""Human drivers as obstacles of a joint plan: never run into, and never waited for in vain."""

import numpy as np
import pytest
from driven import layered, ordered, ordering_of, planned, puppets, stage_of
from worlds import Car, Junction, car

from codriving.datatypes.action import Action
from codriving.geometry.box import TRUE, corners, overlap
from codriving.reasoning.execution.protocol import Executor


def touching(junction: Junction, one: Car, a: np.ndarray, other: Car, b: np.ndarray) -> bool:
    """Whether the bodies of two vehicles overlap at any step."""
    places = [(s, t) for s, t in zip(a, b, strict=True) if np.isfinite(s) and np.isfinite(t)]
    for s, t in places:
        paths = [junction.road_map.paths[c.route] for c in (one, other)]
        bodies = [corners(*p.position(q), p.heading(q), 5.0, 2.0) for p, q in zip(paths, (s, t), strict=True)]
        if overlap(*bodies):
            return True
    return False


def stands_in(junction: Junction, route: str, other: str, share: float) -> Car:
    """A driver who stands in the zone that a route shares with another one, or where the two merge."""
    (zone,) = junction.road_map.zones(route, other, TRUE)
    end = zone.exit_j if zone.merge_j is None else zone.merge_j
    return car("HDV1", other, zone.entry_j + share * (end - zone.entry_j), 0.0)


@pytest.mark.parametrize("make", [planned, layered])
@pytest.mark.parametrize("share", [0.3, 0.5])
@pytest.mark.parametrize("other", ["west-east", "east-west", "west-north"])
def test_a_driver_who_stands_in_a_zone_is_never_run_into(
    other: str, share: float, make: type[Executor], junction: Junction
) -> None:
    human = stands_in(junction, "south-north", other, share)
    for place in (40.0, 80.0):
        me = car("CAV1", "south-north", place, 9.0)
        show = puppets(junction, ordered(junction, executor=make()), [me, human], 20.0)
        assert not touching(junction, me, show.places["CAV1"], human, show.places["HDV1"])
        (zone,) = junction.road_map.zones("south-north", other, TRUE)
        assert show.places["CAV1"].max() < zone.entry_i
        assert show.places["CAV1"].max() > zone.entry_i - 40.0, "it comes near all the same"


def test_nobody_runs_into_a_driver_who_stands_ahead(junction: Junction) -> None:
    me, human = car("CAV1", "south-north", 50.0, 9.0), car("HDV1", "south-north", 85.0, 0.0)
    show = puppets(junction, ordered(junction), [me, human], 15.0)
    assert 60.0 < show.places["CAV1"].max() < 79.5


@pytest.mark.parametrize("make", [planned, layered])
def test_a_driver_who_waits_does_not_hold_up_the_cavs(make: type[Executor], junction: Junction) -> None:
    # Two CAVs cross, and a driver right before the zone lets everybody pass, though nobody can tell that at first.
    (zone,) = junction.road_map.zones("south-north", "west-east")
    for before in (2.0, 6.0):
        cars = [
            car("CAV1", "south-north", 60.0, 8.0),
            car("CAV2", "east-west", 62.0, 8.0),
            car("HDV1", "west-east", zone.entry_j - before, 0.0),
        ]
        show = puppets(junction, ordered(junction, executor=make()), cars, 40.0)
        assert show.arrived("CAV1")
        assert show.arrived("CAV2")


def test_a_driver_who_goes_on_is_let_through(junction: Junction) -> None:
    # Both would be there at the same time, and the driver has the right of way and does nothing about it.
    for place in (60.0, 66.0, 72.0):
        me, human = car("CAV1", "south-north", 66.0, 8.0), car("HDV1", "west-east", place, 8.0)
        show = puppets(junction, ordered(junction), [me, human], 25.0)
        mine, theirs = show.places["CAV1"], show.places["HDV1"]
        assert not touching(junction, me, mine, human, theirs), place
        assert show.arrived("CAV1")
        (zone,) = junction.road_map.zones("south-north", "west-east", TRUE)
        left, entered = np.argmax(theirs > zone.exit_j), np.argmax(mine > zone.entry_i)
        assert (entered - left) * junction.model.step > 1.0, "there is time between the two"


def test_whoever_drives_behind_minds_the_cav_and_not_the_other_way_round(junction: Junction) -> None:
    me, behind = car("CAV1", "south-north", 60.0, 6.0), car("HDV1", "south-north", 53.0, 9.0)
    stage = stage_of(junction.thoughts(me, behind))
    drive = planned().drive(stage, ordering_of("CAV1"))
    assert drive.actions == {"CAV1": Action.FASTER}
    assert drive.expected["HDV1"][0].places[0] == pytest.approx(53.0)


def test_the_one_behind_a_slow_driver_does_not_come_too_close(junction: Junction) -> None:
    me, ahead = car("CAV1", "south-north", 30.0, 9.0), car("HDV1", "south-north", 55.0, 2.0)
    show = puppets(junction, ordered(junction), [me, ahead], 15.0)
    assert (show.places["HDV1"] - show.places["CAV1"]).min() > 5.5
    assert show.places["CAV1"][-1] > 65.0, "it keeps up"
