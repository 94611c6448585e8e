"""What a browser is given is what was driven and decided."""

from itertools import accumulate
from pathlib import Path

import numpy as np
import pytest

from codriving.experiment.stored import find_episode, read_episode, road_of
from codriving.geometry.road_map import road_map
from codriving.pages.replay import questions_of, replay_data, road_data
from codriving.runs.episode_folder import read_decisions


def test_tracks_are_those_of_the_trajectory(two_runs: tuple[Path, Path]) -> None:
    episode = find_episode(two_runs[0], None, 20001)
    record, trajectory = read_episode(episode)
    assert trajectory is not None
    made = replay_data(record, trajectory, read_decisions(episode.folder), (), road_map(road_of(episode.cell)))
    assert made["step"] == 0.1
    for vehicle, track in zip(made["vehicles"], trajectory.tracks, strict=True):
        assert (vehicle["id"], vehicle["kind"], vehicle["first"]) == (track.id, track.kind.value, track.first_step)
        for name, values in (("x", track.x), ("y", track.y), ("v", track.speed)):
            assert np.array(list(accumulate(vehicle[name]))) / 100 == pytest.approx(values, abs=0.00501)
        turned = np.array(list(accumulate(vehicle["h"]))) / 1000 - track.heading
        assert np.abs(np.sin(turned / 2)).max() < 0.001
    assert made["ending"]["text"].startswith("Timeout after 8.0 s")
    assert made["ending"]["good"] is False
    assert [step["t"] for step in made["steps"]] == [0.5 * k for k in range(16)]
    first = made["steps"][0]["cavs"]
    assert sorted(first) == ["CAV1", "CAV2", "CAV3", "CAV4"]
    assert {one["a"] for one in first.values()} <= {"FASTER", "SLOWER", "IDLE", "HOLD"}
    marks = [mark for step in made["steps"] for mark in step["marks"]]
    assert marks
    for one, other, band, apart, certain, place in marks:
        assert one != other
        assert band in (0, 1, 2)
        assert 0 <= apart <= 8
        assert certain in (0, 1)
        assert place is None or max(map(abs, place)) < 15_000  # On the junction, in centimetres


def test_questions_of_a_cav_and_of_none() -> None:
    asked = [{"subject": words, "text": words} for words in ("", "CAV1", "CAV12", "CAV1 and HDV2", "HDV2")]
    assert [line["text"] for line in questions_of("CAV1", ["CAV1", "CAV12"], asked)] == [
        *("", "CAV1", "CAV1 and HDV2", "HDV2"),
    ]


def test_a_road_as_lines_in_centimetres(two_runs: tuple[Path, Path]) -> None:
    road = road_of(find_episode(two_runs[0], None, 20000).cell)
    made = road_data(road_map(road))
    assert len(made["asphalt"]) == len(road.lanes)
    assert sorted(made["routes"]) == sorted(route.id for route in road.routes)
    straight = made["routes"]["south-north"]
    xs, ys = straight[::2], straight[1::2]
    assert max(xs) - min(xs) < 10
    assert ys[0] > 5_000 > -3_000 > ys[-1]
    assert ys == sorted(ys, reverse=True)
