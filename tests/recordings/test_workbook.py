"""The authors' .xlsx: CAVs and places are read, and what earlier recordings left in a file is found."""

import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest
from openpyxl import Workbook

from codriving.datatypes.record import Ending, Outcome
from codriving.datatypes.world import Kind
from codriving.errors import RecordingError
from codriving.metrics.authors import AuthorsMetrics
from codriving.recordings.workbook import read_workbook

Row = Sequence[object]

HEAD = ("t", "x", "y", "v", "theta", "background_veh?")


def workbook(path: Path, sheets: Mapping[str, Sequence[Row]]) -> Path:
    """Write a file as the authors' program does: an empty sheet first, then one a vehicle."""
    book = Workbook()
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(path)
    return path


def drive(count: int, x: float, y: float, vx: float, vy: float, cav: bool = True, first: int = 0) -> list[Row]:
    """Rows of 0.2 s at a steady speed [m/s]."""
    speed, theta = float(np.hypot(vx, vy)), float(np.arctan2(vy, vx))
    return [(first + k, x + 0.2 * k * vx, y + 0.2 * k * vy, speed, round(theta, 2), cav) for k in range(count)]


def crossing(count: int = 50) -> dict[str, list[Row]]:
    """Vehicle 0 is in the middle at 4 s, vehicle 1, a human driver, at 6 s."""
    return {
        "0": [HEAD, *drive(count, -40, 0, 10, 0)],
        "1": [HEAD, *drive(count, 0, -60, 0, 10, cav=False)],
    }


def test_a_recording_is_read_and_scored_as_the_authors_do(tmp_path: Path) -> None:
    found = read_workbook(workbook(tmp_path / "a.xlsx", crossing()))
    assert (found.marked, found.notes, found.trajectory.step) == (True, (), 0.2)
    one, other = found.trajectory.tracks
    assert (one.id, one.kind, other.id, other.kind) == ("0", Kind.CAV, "1", Kind.HDV)
    assert (one.x[0], one.x[49], other.y[49], other.heading[3]) == pytest.approx((-40, 58, 38, 1.57))
    score = AuthorsMetrics().score_recording(found.trajectory, Outcome(Ending.SUCCESS, 10.0, {}))
    assert [(pet.first, pet.second, round(pet.value, 4)) for pet in score.pets] == [("0", "1", 2.0)]
    assert [travel.velocity for travel in score.travels] == [10.0, 10.0]


@pytest.mark.parametrize(
    "below",
    [
        pytest.param(drive(20, -40, 0, 10, 0), id="row numbers begin again"),
        pytest.param(drive(20, 30, 80, 0, -5, first=50), id="the vehicle jumps"),
        pytest.param(drive(20, 60, 0, 10, 0, cav=False, first=50), id="it is no CAV any more"),
    ],
)
def test_rows_that_an_earlier_recording_left_are_found_and_left_out(below: list[Row], tmp_path: Path) -> None:
    sheets = crossing()
    sheets["0"] += below
    found = read_workbook(workbook(tmp_path / "a.xlsx", sheets))
    assert [len(track.x) for track in found.trajectory.tracks] == [50, 50]
    assert found.notes == ("stale rows 52 to 71 of sheet 0, left by an earlier recording, are left out",)


def test_a_sheet_of_another_recording_is_left_out(tmp_path: Path) -> None:
    sheets = crossing()
    # Written over by a recording of 30 rows, when the others were not yet what they are.
    sheets["2"] = [HEAD, *drive(30, 90, 10.5, 10, 0), *drive(20, 20, 0, 10, 0)]
    found = read_workbook(workbook(tmp_path / "a.xlsx", sheets))
    assert [track.id for track in found.trajectory.tracks] == ["0", "1"]
    assert found.notes == ("sheet 2 is of another recording (30 rows where the others have 50) and left out",)


def test_a_vehicle_that_is_gone_early_counts_and_is_named(tmp_path: Path) -> None:
    sheets = {**crossing(), "2": [HEAD, *drive(30, 90, 10.5, 10, 0)]}
    found = read_workbook(workbook(tmp_path / "a.xlsx", sheets))
    assert [track.id for track in found.trajectory.tracks] == ["0", "1", "2"]
    assert found.notes == ("sheet 2 has other than 50 rows",)


def test_sheets_that_a_second_run_appended_are_left_out(tmp_path: Path) -> None:
    again = {f"{name}1": rows for name, rows in crossing(30).items()}
    found = read_workbook(workbook(tmp_path / "a.xlsx", {**crossing(), **again}))
    assert [track.id for track in found.trajectory.tracks] == ["0", "1"]
    assert found.notes == ("appended sheet 01, 11 is of another recording and left out",)


def test_ten_vehicles_are_no_appended_sheets(tmp_path: Path) -> None:
    sheets = {str(k): [HEAD, *drive(5, 20.0 * k, 0, 10, 0)] for k in range(12)}
    found = read_workbook(workbook(tmp_path / "a.xlsx", sheets))
    assert ([track.id for track in found.trajectory.tracks], found.notes) == ([str(k) for k in range(12)], ())


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda rows: [row[:3] for row in rows], "sheet 1: column v is missing; columns: t, x, y"),
        (lambda rows: [*rows[:3], (2, "left", 0, 0, 0, True)], "sheet 1, column x, row 4: 'left' is no number"),
        (lambda rows: [*rows[:3], (2, 0, None, 0, 0, True)], "sheet 1, column y, row 4: an empty cell is no number"),
        (
            lambda rows: [*rows[:3], (2, 0, 0, 0, 0, "yes")],
            "column background_veh?, row 4: 'yes' is neither TRUE nor FALSE",
        ),
    ],
)
def test_what_is_wrong_is_named_with_sheet_and_column(spoil: object, said: str, tmp_path: Path) -> None:
    sheets = crossing()
    sheets["1"] = spoil(sheets["1"])  # type: ignore[operator]
    path = workbook(tmp_path / "a.xlsx", sheets)
    with pytest.raises(RecordingError) as error:
        read_workbook(path)
    assert str(error.value).startswith(str(path)), error.value
    assert said in str(error.value)


def test_what_is_no_workbook_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.xlsx"
    path.write_text("t,x,y", encoding="utf-8")
    with pytest.raises(RecordingError, match=r"is no \.xlsx file that can be read"):
        read_workbook(path)
    Workbook().save(path)
    with pytest.raises(RecordingError, match="has no sheet with the columns t, x, y, v, theta, background_veh"):
        read_workbook(path)
    with pytest.raises(RecordingError, match="cannot read"):
        read_workbook(tmp_path)


def test_entities_are_not_expanded(tmp_path: Path) -> None:
    path, spoilt = workbook(tmp_path / "a.xlsx", crossing(3)), tmp_path / "b.xlsx"
    with zipfile.ZipFile(path) as before, zipfile.ZipFile(spoilt, "w") as after:
        for name in before.namelist():
            text = before.read(name)
            if name == "xl/worksheets/sheet2.xml":
                text = b'<!DOCTYPE a [<!ENTITY b "0">]>' + text
            after.writestr(name, text)
    with pytest.raises(RecordingError, match=r"is no \.xlsx file that can be read .*EntitiesForbidden"):
        read_workbook(spoilt)


def test_a_spoilt_workbook_is_refused_in_a_line(tmp_path: Path) -> None:
    path, spoilt = workbook(tmp_path / "a.xlsx", crossing(3)), tmp_path / "b.xlsx"
    with zipfile.ZipFile(path) as before, zipfile.ZipFile(spoilt, "w") as after:
        for name in before.namelist():
            after.writestr(name, before.read(name).replace(b"calcId", b"calcIt"))
        start = before.getinfo("xl/workbook.xml").header_offset + 30 + len("xl/workbook.xml")
    with pytest.raises(RecordingError, match=r"is no \.xlsx file that can be read .*calcIt"):
        read_workbook(spoilt)
    packed = bytearray(path.read_bytes())
    packed[start + 4 : start + 40] = bytes(36)
    spoilt.write_bytes(packed)
    with pytest.raises(RecordingError, match=r"is no \.xlsx file that can be read .*Error -3 while decompressing"):
        read_workbook(spoilt)
