"""Who is in conflict with whom, seen from both sides."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Car, Junction, car

from codriving.datatypes.order import Conflict, Relation

ROUTES = tuple(
    f"{a}-{b}" for a in ("south", "west", "north", "east") for b in ("south", "west", "north", "east") if a != b
)


def between(junction: Junction, one: Car, other: Car) -> tuple[tuple[Conflict, ...], tuple[Conflict, ...]]:
    conflicts = junction.thoughts(one, other).conflicts
    return conflicts["CAV1"], conflicts.get("CAV2", ())


@pytest.mark.parametrize(
    ("one", "other", "relation"),
    [
        ("south-north", "west-east", Relation.CROSSING),
        ("south-north", "east-west", Relation.CROSSING),
        ("south-north", "north-east", Relation.CROSSING),
        ("south-west", "east-south", Relation.CROSSING),
        ("south-north", "west-north", Relation.CONVERGING),
        ("south-east", "west-east", Relation.CONVERGING),
        ("south-east", "north-east", Relation.CONVERGING),
    ],
)
def test_textbook_conflicts(one: str, other: str, relation: Relation, junction: Junction) -> None:
    mine, theirs = between(junction, car("CAV1", one, 60.0, 8.0), car("CAV2", other, 60.0, 8.0))
    assert [c.relation for c in mine] == [c.relation for c in theirs] == [relation]
    assert mine[0].certain


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("south-north", "north-south"),
        ("south-west", "north-east"),
        ("south-east", "north-west"),
        ("south-east", "west-south"),
        ("south-north", "south-west"),
        ("south-north", "south-north"),
    ],
)
def test_textbook_absences(one: str, other: str, junction: Junction) -> None:
    assert between(junction, car("CAV1", one, 60.0, 8.0), car("CAV2", other, 40.0, 8.0)) == ((), ())


@settings(max_examples=40, deadline=None)
@given(
    st.sampled_from(ROUTES),
    st.sampled_from(ROUTES),
    st.floats(30.0, 180.0),
    st.floats(30.0, 180.0),
    st.floats(0.0, 9.0),
    st.floats(0.0, 9.0),
)
def test_both_sides_see_the_same(
    junction: Junction, one: str, other: str, s: float, t: float, v: float, w: float
) -> None:
    mine, theirs = between(junction, car("CAV1", one, s, v), car("CAV2", other, t, w))
    assert len(mine) == len(theirs)
    for a, b in zip(mine, theirs, strict=True):
        assert (a.relation, a.severity, a.dttcp) == (b.relation, b.severity, b.dttcp)
        for name in ("routes", "places", "distances", "exits", "ttcp"):
            assert getattr(a, name) == getattr(b, name)[::-1]
        assert a.relation in (Relation.CROSSING, Relation.CONVERGING)
        assert a.dttcp == abs(a.ttcp[0] - a.ttcp[1])
        assert min(a.distances) >= 0
        assert min(a.exits) >= 0


def test_no_conflict_past_the_zone(junction: Junction) -> None:
    (zone,) = junction.road_map.zones("south-north", "west-east")
    far = car("CAV2", "west-east", 60.0, 8.0)
    assert between(junction, car("CAV1", "south-north", zone.exit_i - 0.5, 8.0), far)[0]
    assert between(junction, car("CAV1", "south-north", zone.exit_i + 0.5, 8.0), far) == ((), ())


@pytest.mark.parametrize("name", ["CAV2", "HDV2"])
def test_where_ways_merge_nothing_is_open_once_one_has_passed_the_beginning(name: str, junction: Junction) -> None:
    # The zone begins at 109.4 m of one way and at 108.7 m of the other.
    far, near = car(name, "west-north", 80.0, 8.0), car(name, "west-north", 110.0, 8.0)
    for place, other, is_open in ((109.0, far, True), (110.0, far, False), (180.0, far, False), (100.0, near, False)):
        found, _ = between(junction, car("CAV1", "south-north", place, 8.0), other)
        assert any(c.relation is Relation.CONVERGING for c in found) is is_open


def test_a_vehicle_that_comes_by_a_lane_change_may_still_be_beside(merge: Junction) -> None:
    # By its place the one on the ramp is in the zone from 299.5 m on, but it has not changed lanes yet.
    for place, other, is_open in ((250.0, 312.0, True), (310.0, 305.0, True), (325.0, 305.0, False)):
        found, _ = between(merge, car("CAV1", "main-1", place, 15.0), car("CAV2", "ramp", other, 15.0, offset=3.0))
        assert bool(found) is is_open


def test_most_urgent_first(junction: Junction) -> None:
    conflicts = junction.thoughts(
        car("CAV1", "south-north", 70.0, 8.0),
        car("CAV2", "west-east", 20.0, 8.0),
        car("CAV3", "east-west", 70.0, 8.0),
        car("CAV4", "west-north", 50.0, 8.0),
    ).conflicts["CAV1"]
    assert [c.other for c in conflicts] == ["CAV3", "CAV4", "CAV2"]


def test_a_human_driver_is_in_conflict_on_each_route_that_it_may_take(junction: Junction) -> None:
    mine, none = between(junction, car("CAV1", "south-north", 80.0, 8.0), car("HDV1", "west-south", 80.0, 8.0))
    assert {c.routes[1] for c in mine} == {"west-east", "west-north"}
    assert not any(c.certain for c in mine)
    assert none == ()


def test_inside_the_zone_the_distance_is_none_and_the_time_zero(junction: Junction) -> None:
    mine, _ = between(junction, car("CAV1", "south-north", 108.0, 5.0), car("CAV2", "west-east", 60.0, 8.0))
    assert mine[0].distances[0] == mine[0].ttcp[0] == 0
    assert mine[0].exits[0] > 0
