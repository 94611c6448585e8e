"""The space-time diagram: what is blocked when, and that a picture comes of it."""

import re
from collections.abc import Mapping
from typing import Any

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes import Kind, Scenario, Track, Trajectory
from codriving.datatypes.record import Collision, Ending, EpisodeRecord, Outcome
from codriving.geometry import TRUE, RoadMap, road_map
from codriving.pages.space_time import space_time_figure, ways_of
from codriving.reports.figures import saved

STEP = 0.1


@pytest.fixture(scope="module")
def road() -> RoadMap:
    config = compose(["scenario=intersection"])
    return road_map(build(config["scenario"], Scenario, "scenario", config["plugins"]).road)


def driven(road: RoadMap, name: str, route: str, kind: Kind, start: float, speed: float, beside: float = 0.0) -> Track:
    """A vehicle that drives along its route, or on a lane beside it."""
    s = start + speed * STEP * np.arange(120)
    path = road.paths[route]
    x, y = path.position(s)
    heading = path.heading(s)
    x, y = x - beside * np.sin(heading), y + beside * np.cos(heading)
    rest = np.full(len(s), speed), np.zeros(len(s)), ("",) * len(s)
    return Track(name, kind, route, 0, x, y, heading, *rest, None)


def crossing(road: RoadMap, gap: float, beside: float = 0.0) -> Trajectory:
    """A human driver who is past the conflict point of the two so many seconds before the CAV is there."""
    (zone,) = road.zones("south-north", "west-east", TRUE)
    first = driven(road, "HDV1", "west-east", Kind.HDV, zone.point_j - 40.0, 8.0, beside)
    ego = driven(road, "CAV1", "south-north", Kind.CAV, zone.point_i - 40.0 - 8.0 * gap, 8.0)
    return Trajectory(STEP, (ego, first))


def test_ground_is_blocked_while_the_other_is_on_it(road: RoadMap) -> None:
    (way,) = ways_of(crossing(road, 3.0), road)
    (zone,) = road.zones("south-north", "west-east", TRUE)
    assert way.zones == ((zone.entry_i, zone.exit_i),)
    (ground,) = way.blocked
    seen = np.isfinite(ground.low)
    # The other is at the conflict point after 5 s; the zone is some 14 m long.
    assert ground.time[seen][0] == pytest.approx(5 - (zone.point_j - zone.entry_j) / 8, abs=0.11)
    assert ground.time[seen][-1] == pytest.approx(5 + (zone.exit_j - zone.point_j) / 8, abs=0.11)
    assert ground.low[seen].min() == pytest.approx(zone.entry_i, abs=0.3)
    assert ground.high[seen].max() == pytest.approx(zone.exit_i, abs=0.3)


@pytest.mark.parametrize(("gap", "met"), [(3.0, False), (0.0, True)])
def test_the_line_of_a_cav_is_in_blocked_ground_only_where_the_two_touch(road: RoadMap, gap: float, met: bool) -> None:
    (way,) = ways_of(crossing(road, gap), road)
    (ground,) = way.blocked
    with np.errstate(invalid="ignore"):
        inside = (way.place > ground.low) & (way.place < ground.high)
    assert inside.any() == met


def test_who_is_on_another_lane_blocks_nothing(road: RoadMap) -> None:
    (way,) = ways_of(crossing(road, 0.0, beside=3.5), road)
    assert way.blocked == ()


def record(ending: Ending, collision: Collision | None = None) -> EpisodeRecord:
    return EpisodeRecord("intersection", "$m$", "", "none", 3, Outcome(ending, 12.0, {}, collision), {}, (), 4, {})


def test_the_picture_says_who_and_where_and_is_the_same_each_time(
    road: RoadMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[Figure] = []

    def kept(figure: Figure, *others: Any) -> Mapping[str, bytes]:
        made.append(figure)
        return saved(figure, *others)

    monkeypatch.setattr("codriving.pages.space_time.saved", kept)
    hit = record(Ending.COLLISION, Collision(5.0, "CAV1", "HDV1", "CAV-HDV"))
    found = space_time_figure(crossing(road, 0.0), hit, road.road, "name")
    assert set(found) == {"name.png", "name.svg"}
    with matplotlib.rc_context({"font.size": 20, "hatch.linewidth": 9}):
        assert space_time_figure(crossing(road, 0.0), hit, road.road, "name") == found
    said = set(re.findall(r"<!-- (.*?) -->", found["name.svg"].decode()))
    assert {
        *("CAV1, south-north", "conflict zone", "blocked by HDV1", "time [s]"),
        "space-time - intersection, $m$, seed 3: collision",
    } <= said
    space_time_figure(crossing(road, 3.0), record(Ending.SUCCESS), road.road, "name")
    assert [[text.get_text() for text in figure.axes[0].texts] for figure in (made[0], made[-1])] == [
        ["HDV1", "collision"],
        ["HDV1"],
    ]


def test_only_the_first_twelve_have_a_panel(road: RoadMap) -> None:
    tracks = [driven(road, f"CAV{k}", "south-north", Kind.CAV, 100.0 - 8 * k, 8.0) for k in range(13)]
    svg = space_time_figure(Trajectory(STEP, tuple(tracks)), record(Ending.SUCCESS), road.road, "n")["n.svg"].decode()
    assert sum(f"<!-- CAV{k}, south-north -->" in svg for k in range(13)) == 12
