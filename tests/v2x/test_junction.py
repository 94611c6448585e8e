"""Where a road side unit stands."""

import pytest
from worlds import Junction

from codriving.v2x.junction import centre


def test_a_unit_stands_where_routes_meet(junction: Junction, merge: Junction, highway: Junction) -> None:
    assert centre(junction.road_map) == (pytest.approx(0.0, abs=2.0), pytest.approx(0.0, abs=2.0))
    for other in (merge, highway):
        x, y = centre(other.road_map)
        spans = [
            path.position(s)
            for name, path in other.road_map.paths.items()
            for s in (0.0, other.road_map.routes[name].goal)
        ]
        assert min(p[0] for p in spans) < x < max(p[0] for p in spans)
        assert abs(y) < 30.0
