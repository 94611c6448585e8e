"""CSV of anyone's: tidy tables, and the tracks of INTERACTION and inD, in small files of these layouts."""

from pathlib import Path

import numpy as np
import pytest

from codriving.datatypes.world import Kind
from codriving.errors import RecordingError
from codriving.recordings.csv_file import read_csv


def written(tmp_path: Path, text: str, name: str = "a.csv") -> Path:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def test_a_tidy_table_needs_no_more_than_places_and_times(tmp_path: Path) -> None:
    rows = [f"{0.5 * k},{who},{x},{y}" for k in range(4) for who, x, y in (("a", 5 * k, 0), ("b", 3, max(0, k - 2)))]
    found = read_csv(written(tmp_path, "\n".join(["time,id,x,y", *reversed(rows)])))
    b, a = found.trajectory.tracks
    assert (found.marked, found.trajectory.step, a.kind, a.first_step) == (False, 0.5, Kind.CAV, 0)
    assert a.speed == pytest.approx([10, 10, 10, 10])
    assert a.heading == pytest.approx([0, 0, 0, 0])
    # One that stands looks where it will drive.
    assert b.heading == pytest.approx([np.pi / 2] * 4)
    assert (a.length, a.width) == (5.0, 2.0)


def test_a_tidy_table_may_say_more(tmp_path: Path) -> None:
    head = "time,id,kind,x,y,heading,speed,acceleration,length,width,colour"
    rows = [
        f"{k / 10:.4f},{who},{kind},{k},0,0.1,9.5,-1,{long},2.5,red"
        for k in range(9)
        for who, kind, long in (("a", "CAV", 4.5), ("b", "HDV", 12))
    ]
    a, b = read_csv(written(tmp_path, "\n".join([head, *rows]))).trajectory.tracks
    assert (a.kind, b.kind, a.length, b.length, b.width) == (Kind.CAV, Kind.HDV, 4.5, 12.0, 2.5)
    assert (a.heading[0], a.speed[0], a.acceleration[0]) == (0.1, 9.5, -1.0)


def test_one_that_is_gone_for_a_while_is_two(tmp_path: Path) -> None:
    rows = [f"{k},a,{10 * k},0" for k in (0, 1, 2, 6, 7)] + [f"{k},b,0,{k}" for k in range(8)]
    found = read_csv(written(tmp_path, "\n".join(["time,id,x,y", *rows])))
    assert [(track.id, track.first_step, len(track.x)) for track in found.trajectory.tracks] == [
        ("a", 0, 3),
        ("a#2", 6, 2),
        ("b", 0, 8),
    ]
    assert found.notes == ("missing times: a is gone for a while, and is another vehicle after that",)


INTERACTION = "track_id,frame_id,timestamp_ms,agent_type,x,y,vx,vy,psi_rad,length,width"


def test_tracks_of_interaction(tmp_path: Path) -> None:
    rows = [f"1,{k},{100 * k},car,{990 + 0.8 * k},{1000 + 0.6 * k},8,6,0.6435,4.2,1.8" for k in range(1, 6)]
    rows += [f"P7,{k},{100 * k},pedestrian/bicycle,{990 + k},{1000},1,0,,," for k in range(1, 6)]
    found = read_csv(written(tmp_path, "\n".join([INTERACTION, *rows])))
    (track,) = found.trajectory.tracks
    assert (found.trajectory.step, track.id, track.length, track.width) == (0.1, "1", 4.2, 1.8)
    assert (track.speed[0], track.heading[0], track.x[4]) == pytest.approx((10.0, 0.6435, 994.0))
    assert found.notes == ("left out, as no motor vehicle: pedestrian/bicycle",)


def test_cases_of_interaction_do_not_meet(tmp_path: Path) -> None:
    rows = [f"{case}.0,1,{k},{100 * k},car,{k},0,10,0,0,4.2,1.8" for case in (1, 2) for k in range(1, 4)]
    tracks = read_csv(written(tmp_path, "\n".join([f"case_id,{INTERACTION}", *rows]))).trajectory.tracks
    assert [track.id for track in tracks] == ["1/1", "2/1"]
    assert tracks[1].first_step == tracks[0].first_step + 36000


IND = "recordingId,trackId,frame,trackLifetime,xCenter,yCenter,heading,width,length,xVelocity,yVelocity"


def ind(tmp_path: Path) -> Path:
    rows = [f"0,3,{100 + k},{k},{50 - 0.4 * k},-20,180,1.9,4.4,-10,0" for k in range(5)]
    rows += [f"0,4,{100 + k},{k},{50 + k},-30,0,0,0,1,0" for k in range(5)]
    return written(tmp_path, "\n".join([IND, *rows]), "00_tracks.csv")


def test_tracks_of_ind_alone(tmp_path: Path) -> None:
    found = read_csv(ind(tmp_path))
    (track,) = found.trajectory.tracks
    assert (track.id, found.trajectory.step, track.length, track.width) == ("3", 0.04, 4.4, 1.9)
    assert (track.heading[0], track.speed[0]) == pytest.approx((np.pi, 10.0))
    assert found.notes == (
        "no file 00_recordingMeta.csv beside it: 25 frames a second taken",
        "1 pedestrians and cyclists, who have no length, are left out",
    )


def test_tracks_of_ind_with_the_files_beside_them(tmp_path: Path) -> None:
    path = ind(tmp_path)
    written(tmp_path, "recordingId,frameRate\n0,25", "00_recordingMeta.csv")
    written(tmp_path, "trackId,class\n3,truck_bus\n4,pedestrian", "00_tracksMeta.csv")
    found = read_csv(path)
    assert [track.id for track in found.trajectory.tracks] == ["3"]
    assert found.notes == ("left out, as no motor vehicle: pedestrian",)
    written(tmp_path, "recordingId,frameRate\n0,none", "00_recordingMeta.csv")
    with pytest.raises(RecordingError, match=r"00_recordingMeta\.csv, column frameRate, row 2: 'none' is no number"):
        read_csv(path)


GOOD = [f"{k},a,{10 * k},0,10,CAV" for k in range(5)]


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (["time,id,x,speed", "0,a,1,2"], "column y is missing for a tidy CSV; columns: time, id, x, speed"),
        (
            ["trackId,frame,xCenter,yCenter,heading,width,xVelocity,yVelocity"],
            "column length is missing for the tracks of inD",
        ),
        (["time,id,x,y,speed,kind"], "has no row of a vehicle"),
        (["time,id,x,y,speed,kind", *GOOD, "5,a,fast,0,10,CAV"], ", column x, row 7: 'fast' is no number"),
        (["time,id,x,y,speed,kind", *GOOD, "5,a,,0,10,CAV"], ", column x, row 7: an empty cell is no number"),
        (["time,id,x,y,speed,kind", *GOOD, "5,a,inf,0,10,CAV"], ", column x, row 7: 'inf' is no number"),
        (["time,id,x,y,speed,kind", *GOOD, "5,,50,0,10,CAV"], ", column id, row 7: the cell is empty"),
        (["time,id,x,y,speed,kind", *GOOD, "5,a,50,0,10,tram"], ", column kind, row 7: 'tram' is neither CAV nor HDV"),
        (["time,id,x,y,speed,kind", *GOOD, "4,a,50,0,10,CAV"], "vehicle a has two rows at 4 s"),
        (["time,id,x,y,speed,kind", *GOOD, "5.5,a,55,0,10,CAV"], "times are not"),
        (["time,id,x,y,speed", *(f"{k},a,{10 * k},0,36" for k in range(5))], "positions and speeds do not agree"),
        (["time,id,x,y, x", *(f"{k},a,{10 * k},0,3" for k in range(5))], "has two columns x; keep one of them"),
        ([""], "is no CSV that can be read"),
        (['time,id,x,y\n"0,a,1,2'], "is no CSV that can be read"),
    ],
)
def test_what_is_wrong_is_named_with_column_and_row(rows: list[str], said: str, tmp_path: Path) -> None:
    path = written(tmp_path, "\n".join(rows))
    with pytest.raises(RecordingError) as error:
        read_csv(path)
    assert str(error.value).startswith(str(path))
    assert said in str(error.value)
    assert "\n" not in str(error.value)
