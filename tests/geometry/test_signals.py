"""Which side is signalled where."""

from collections.abc import Callable

import pytest
from worlds import Junction

from codriving.environment.environment import Environment


@pytest.mark.parametrize(("route", "side"), [("south-west", "left"), ("south-east", "right"), ("south-north", "")])
def test_a_turn_at_the_intersection_is_signalled_from_30_m_before_it_to_its_end(
    route: str, side: str, junction: Junction
) -> None:
    signals = junction.road_map.signals
    # Legs are 100 m long; the turns are 14.1 m (right) and 20.4 m (left).
    end = {"left": 120.4, "right": 114.1, "": 115.0}[side]
    assert [signals.shown(route, s) for s in (69.9, 70.1, 100.0, end - 0.5, end + 0.5)] == ["", side, side, side, ""]


def test_at_the_roundabout_it_is_signalled_who_leaves(configured: Callable[..., Environment]) -> None:
    road_map = configured("scenario=roundabout").road_map
    for name, route in road_map.routes.items():
        leaves = road_map.lane_start(name, route.lanes[-2])
        shown = [road_map.signals.shown(name, s) for s in (20.0, 60.0, 100.0, leaves - 1.0, leaves + 1.0)]
        assert shown == ["", "", "", "right", "right"], name


@pytest.mark.parametrize("road_name", ["highway", "merge"])
def test_where_no_way_divides_nothing_is_signalled(road_name: str, request: pytest.FixtureRequest) -> None:
    road_map = request.getfixturevalue(road_name).road_map
    assert {road_map.signals.shown(name, s) for name in road_map.routes for s in range(0, 400, 5)} == {""}
