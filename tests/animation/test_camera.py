"""The CAVs are in view at every moment, and the view moves calmly."""

from dataclasses import replace

import numpy as np
import pytest
from crossing import crossing, highway, track

from codriving.animation.camera import CLOSEST, Camera, overview
from codriving.animation.window import Area
from codriving.datatypes.record import Trajectory
from codriving.datatypes.road import Lane, Road, Route, Straight, Turn
from codriving.datatypes.world import Kind
from codriving.geometry.road_map import RoadMap, road_map

VIEW = Area(0.0, 0.0, 896.0, 720.0)


def large() -> RoadMap:
    """A crossing of two roads of 400 m each."""
    east = Lane(("w", "e", 0), Straight((-200.0, 0.0), (200.0, 0.0)))
    south = Lane(("n", "s", 0), Straight((0.0, -200.0), (0.0, 200.0)))
    routes = [Route(name, (lane.id,), Turn.STRAIGHT, 195.0, 390.0) for name, lane in (("east", east), ("south", south))]
    return road_map(Road("large", (east, south), tuple(routes)))


def drive(*starts: float) -> Trajectory:
    """CAVs that come from the west towards the crossing and beyond it."""
    tracks = []
    for k, start in enumerate(starts):
        own = track(f"CAV{k + 1}", "east", 0.0, 10.0, 200)
        tracks.append(replace(own, x=start + np.arange(200.0), y=np.zeros(200)))
    return Trajectory(0.1, tuple(tracks))


def test_every_cav_is_in_view_at_every_moment() -> None:
    trajectory = drive(-150.0, -60.0)
    camera = Camera(trajectory, large(), VIEW)
    for time in np.arange(0.0, 19.9, 0.23):
        (window,) = camera.at(time)
        k = round(time / 0.1)
        assert all(window.owns((t.x[k], t.y[k])) for t in trajectory.tracks), time


def test_it_comes_closer_where_they_are_and_never_too_close() -> None:
    camera = Camera(drive(-150.0), large(), VIEW)
    zooms = [camera.at(time)[0].zoom for time in np.arange(0.0, 20.0, 0.1)]
    assert zooms[0] < 3.0
    assert max(zooms) == pytest.approx(CLOSEST, rel=0.05)
    assert np.abs(np.diff(np.log(zooms))).max() < 0.06


def test_it_stays_over_the_crossing() -> None:
    camera = Camera(drive(-150.0, -120.0), large(), VIEW)
    assert {(w.x, w.y) for time in (0.0, 5.0, 12.0) for w in camera.at(time)} == {
        (camera.still[0].x, camera.still[0].y)
    }
    assert camera.still[0].y == pytest.approx(0.0, abs=3)


def test_a_junction_is_never_cut_into_rows() -> None:
    assert len(Camera(drive(-190.0, 0.0), large(), VIEW).at(0.0)) == 1


def test_where_every_vehicle_is_far_from_the_shared_part_they_are_in_the_middle() -> None:
    trajectory = Trajectory(0.1, (replace(drive(-150.0).tracks[0], x=np.linspace(-190.0, -150.0, 200)),))
    (window,) = Camera(trajectory, large(), VIEW).at(3.0)
    assert window.x == pytest.approx(-170.0)


def test_a_long_road_is_shown_as_a_whole_in_rows_that_stay() -> None:
    track = replace(drive(0.0).tracks[0], x=np.linspace(20.0, 780.0, 200), y=np.zeros(200))
    camera = Camera(Trajectory(0.1, (track,)), highway(), VIEW)
    windows = camera.at(0.0)
    assert len(windows) > 2
    assert windows is camera.at(9.0)
    for x in np.linspace(20.0, 780.0, 50):
        assert sum(window.owns((x, 0.0)) for window in windows) == 1


def test_a_row_shows_lanes_that_no_vehicle_drives_on() -> None:
    windows = overview(np.array([(0.0, 0.0), (780.0, 0.0)]), highway(lanes=4), VIEW)
    assert all(windows[1].sees([(windows[1].x, y)]) for y in (0.0, 4.0, 8.0, 12.0))


def test_without_cavs_the_others_are_looked_at() -> None:
    human = replace(drive(-150.0).tracks[0], kind=Kind.HDV)
    (window,) = Camera(Trajectory(0.1, (human,)), large(), VIEW).at(0.0)
    assert window.owns((-150.0, 0.0))


def test_one_that_stands_still_can_be_looked_at() -> None:
    still = replace(track("CAV1", "east", 5.0, 0.0, 1))
    (window,) = Camera(Trajectory(0.1, (still,)), crossing(), VIEW).at(0.0)
    assert window.owns((-25.0, 0.0))
