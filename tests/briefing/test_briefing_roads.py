"""What is told where lanes end, run side by side or are full, and from when to when others are in a zone."""

import math
from collections.abc import Callable

import pytest
from worlds import Car, Junction, car

from codriving.briefing.briefing import Briefing
from codriving.datatypes.outlook import Outlook
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment


def told(junction: Junction, *cars: Car) -> Outlook:
    return Briefing().outlook(junction.thoughts(*cars).safety_input("CAV1"))


@pytest.mark.parametrize(("place", "behind"), [(120.9, "CAV2"), (121.1, "")])
def test_a_vehicle_follows_within_40_m(place: float, behind: str, junction: Junction) -> None:
    cars = car("CAV1", "south-north", 80, 8, 9), car("HDV1", "east-west", 76, 8), car("CAV2", "east-west", place, 8)
    assert [(h.id, h.behind) for h in told(junction, *cars).humans] == [("HDV1", behind)]


@pytest.mark.parametrize(("mine", "its", "said"), [(0.4, 0.4, 1), (0.6, 0.4, 0), (0.4, 0.6, 0)])
def test_both_stand_below_half_a_metre_a_second(mine: float, its: float, said: int, junction: Junction) -> None:
    cars = car("CAV1", "south-north", 88, mine, 0), car("HDV1", "east-west", 88, its)
    assert len(told(junction, *cars).norms) == said


@pytest.mark.parametrize(("place", "said"), [(127, 1), (128, 0)])
def test_a_full_exit_is_told(place: float, said: int, configured: Callable[..., Environment]) -> None:
    steady = Junction(configured("scenario=intersection", "environment.steady=true"))
    norms = told(steady, car("CAV1", "south-north", 80, 6), car("HDV1", "south-north", place, 0)).norms
    assert norms == ("HDV1 leaves no room past the junction: do not enter what you cannot leave",) * said


def test_who_has_to_leave_a_lane_that_ends_is_to_be_let_in_and_goes_second(merge: Junction) -> None:
    main, ramp = ("main-1", 150, 20), ("ramp", 140, 18)
    let_in = told(merge, car("CAV1", *main), car("HDV1", *ramp))
    assert [h.first_by_rule for h in let_in.humans] == ["you"]
    assert [norm.startswith("a lane ends beside yours") for norm in let_in.norms] == [True]
    leaves = told(merge, car("CAV1", *ramp), car("HDV1", *main))
    assert [h.first_by_rule for h in leaves.humans] == ["it"]
    assert leaves.norms == ()


def test_the_one_behind_on_the_lane_that_an_action_leads_to(highway: Junction) -> None:
    cars = car("CAV1", "lane-1", 100, 25), car("HDV1", "lane-1", 80, 26), car("HDV2", "lane-0", 85, 26)
    behind = {a.action: a.follower for a in told(highway, *cars).actions}
    assert behind[Action.IDLE] == behind[Action.SLOWER] == "HDV1"
    assert behind[Action.LANE_LEFT] == "HDV2"
    assert behind[Action.LANE_RIGHT] == ""


@pytest.mark.parametrize(("place", "speed"), [(76, 8), (76, 3), (80, 3)])
def test_a_driver_who_merges_has_left_a_length_down_the_common_stretch(
    place: float, speed: float, junction: Junction
) -> None:
    """It may turn onto the CAV's road, and keeps its speed, beyond the 10 s of the forecast, too."""
    cars = car("CAV1", "east-west", 80, 8, 9), car("HDV1", "south-north", place, speed)
    given = junction.thoughts(*cars).safety_input("CAV1")
    c, passage = given.conflicts[0], Briefing().outlook(given).passages[0]
    zone = junction.road_map.zones(*c.routes)[c.zone]
    assert (c.routes[1], c.places[1]) == ("south-west", place)
    assert zone.merge_j is not None
    assert passage.enters == pytest.approx((zone.entry_j - place) / speed, abs=0.2)
    assert passage.leaves == pytest.approx((zone.merge_j + 5 - place) / speed, abs=0.2)


def test_who_stands_is_nowhere_after_the_forecast(junction: Junction) -> None:
    found = told(junction, car("CAV1", "east-west", 80, 8, 9), car("HDV1", "south-north", 76, 0.4)).passages
    assert {(passage.enters, passage.leaves) for passage in found} == {(math.inf, math.inf)}
