"""trajectory.csv: columns, order, decimals, and back."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.datatypes.record import Ending, EpisodeRecord, FlowLog, Outcome, Participant, Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.errors import RunFolderError
from codriving.runs.trajectory_file import TRAJECTORY, read_trajectory, trajectory_text


def track(name: str, kind: Kind, first: int, positions: list[float], action: str) -> Track:
    x = np.array(positions, dtype=float)
    return Track(name, kind, "r", first, x, -x, x * 0 - 1e-6, x * 0 + 8, x * 0, (action,) * len(x), None)


def test_rows_go_by_time_and_then_by_track() -> None:
    tracks = (track("CAV1", Kind.CAV, 0, [0, 1 / 3, 2], "FASTER"), track("HDV1", Kind.HDV, 1, [5], ""))
    assert trajectory_text(Trajectory(1 / 15, tracks)).splitlines() == [
        "time,id,kind,x,y,heading,speed,acceleration,action",
        "0.0000,CAV1,CAV,0.0000,0.0000,0.0000,8.0000,0.0000,FASTER",
        "0.0667,CAV1,CAV,0.3333,-0.3333,0.0000,8.0000,0.0000,FASTER",
        "0.0667,HDV1,HDV,5.0000,-5.0000,0.0000,8.0000,0.0000,",
        "0.1333,CAV1,CAV,2.0000,-2.0000,0.0000,8.0000,0.0000,FASTER",
    ]


def test_no_vehicle_gives_the_header_alone() -> None:
    assert trajectory_text(Trajectory(0.1, ())) == "time,id,kind,x,y,heading,speed,acceleration,action\n"


def test_a_position_that_is_not_finite_is_refused() -> None:
    with pytest.raises(ValueError, match="CAV1 holds a value that is not finite"):
        trajectory_text(Trajectory(0.1, (track("CAV1", Kind.CAV, 0, [0, np.nan], "IDLE"),)))


def members(record: EpisodeRecord, *tracks: Track) -> EpisodeRecord:
    return replace(record, participants=tuple(Participant(t.id, t.kind, t.route, t.arrived) for t in tracks))


def stored(folder: Path, trajectory: Trajectory, record: EpisodeRecord) -> Trajectory | None:
    (folder / TRAJECTORY).write_text(trajectory_text(trajectory), encoding="utf-8")
    return read_trajectory(folder, members(record, *trajectory.tracks))


@given(frequency=st.integers(5, 50), first=st.integers(0, 60), rows=st.integers(2, 60))
def test_what_was_written_is_read_back(
    tmp_path_factory: pytest.TempPathFactory, frequency: int, first: int, rows: int
) -> None:
    record = EpisodeRecord("s", "m", "v", "r", 0, Outcome(Ending.SUCCESS, 1.0, {}), None, (), 0, {})
    one = replace(track("CAV1", Kind.CAV, 0, list(np.linspace(0, 99, first + rows)), "IDLE"), arrived=2.5)
    two = track("HDV1", Kind.HDV, first, list(np.linspace(-9, 9, rows)), "")
    read = stored(tmp_path_factory.mktemp("episode"), Trajectory(1 / frequency, (one, two)), record)
    assert read is not None
    assert read.step == pytest.approx(1 / frequency, abs=1e-4)
    for before, after in zip((one, two), read.tracks, strict=True):
        for name in ("id", "kind", "route", "first_step", "action", "arrived"):
            assert getattr(before, name) == getattr(after, name)
        for name in ("x", "y", "heading", "speed", "acceleration"):
            np.testing.assert_allclose(getattr(before, name), getattr(after, name), atol=1e-4)


def test_in_a_flow_the_road_may_be_empty_for_a_while(record: EpisodeRecord, tmp_path: Path) -> None:
    flow = replace(record, outcome=Outcome(Ending.COUNTED, 9.0, {}, flow=FlowLog(5.0, 0.1, (), ())))
    tracks = (track("CAV1", Kind.CAV, 0, [0, 1, 2], "IDLE"), track("HDV1", Kind.HDV, 50, [5, 6], ""))
    found = stored(tmp_path, Trajectory(0.1, tracks), flow)
    assert found is not None
    assert found.step == 0.1
    assert [(one.id, one.first_step, len(one.x)) for one in found.tracks] == [("CAV1", 0, 3), ("HDV1", 50, 2)]


def test_a_flow_in_which_no_vehicle_came_in_is_read(record: EpisodeRecord, tmp_path: Path) -> None:
    flow = replace(record, outcome=Outcome(Ending.COUNTED, 9.0, {}, flow=FlowLog(5.0, 0.1, (), ())))
    found = stored(tmp_path, Trajectory(0.1, ()), flow)
    assert found is not None
    assert (found.step, found.tracks) == (0.1, ())
    assert read_trajectory(tmp_path / "elsewhere", flow) is None


def test_a_single_row_is_read(record: EpisodeRecord, tmp_path: Path) -> None:
    read = stored(tmp_path, Trajectory(0.1, (track("CAV1", Kind.CAV, 0, [3.0], ""),)), record)
    assert read is not None
    assert (len(read.tracks[0].x), read.tracks[0].first_step) == (1, 0)


def test_where_nothing_was_driven_there_is_nothing(record: EpisodeRecord, tmp_path: Path) -> None:
    assert read_trajectory(tmp_path, record) is None
    assert stored(tmp_path, Trajectory(0.1, ()), record) is None


@pytest.mark.parametrize(
    ("was", "becomes", "said"),
    [
        ("time,id", "when,id", "its columns are not time, id, kind"),
        ("0.0000,CAV1,CAV,0.0000", "0.0000,CAV1,CAV,much", "could not convert"),
        ("0.0000,CAV1,CAV,0.0000", "0.0000,CAV1,CAV,nan", "the rows of CAV1 are not complete"),
        ("0.1000,CAV1,CAV,1.0000,-1.0000,0.0000,8.0000,0.0000,IDLE\n", "", "the rows of CAV1 are not complete"),
        (",CAV1,", ",CAV9,", "CAV9 is not in the record"),
        (",IDLE\n", "\n", "zip"),
        ("CAV1,CAV", "CAV1,TANK", "TANK"),
    ],
)
def test_a_damaged_file_is_named(record: EpisodeRecord, tmp_path: Path, was: str, becomes: str, said: str) -> None:
    one, two = track("CAV1", Kind.CAV, 0, [0, 1, 2], "IDLE"), track("HDV1", Kind.HDV, 0, [0, 1, 2], "")
    text = trajectory_text(Trajectory(0.1, (one, two)))
    assert was in text
    (tmp_path / TRAJECTORY).write_text(text.replace(was, becomes), encoding="utf-8")
    with pytest.raises(RunFolderError, match=f"{TRAJECTORY} is damaged .*{said}.*run again"):
        read_trajectory(tmp_path, members(record, one, two))
