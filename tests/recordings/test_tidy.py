"""A tidy table is read again as what was written."""

from pathlib import Path

import numpy as np
import pytest

from codriving.datatypes.record import Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.recordings.csv_file import read_csv
from codriving.recordings.tidy import tidy_text


def test_what_is_written_is_read_again(tmp_path: Path) -> None:
    t = np.arange(0, 2, 1 / 15)
    ones = np.ones(len(t))
    a = Track("a,b", Kind.CAV, "south-north", 0, 10 * t, 0 * t, 0 * t, 10 * ones, 0 * t, ("IDLE",) * len(t), None)
    b = Track("c", Kind.HDV, "", 3, 3 * ones, 8 * t, ones * np.pi / 2, 8 * ones, -ones, ("",) * len(t), None, 12.0, 2.5)
    path = tmp_path / "a.csv"
    text = tidy_text(Trajectory(1 / 15, (a, b)))
    assert text.splitlines()[:2] == [
        "time,id,kind,route,x,y,heading,speed,acceleration,length,width,action",
        '0.0000,"a,b",CAV,south-north,0.0000,0.0000,0.0000,10.0000,0.0000,5.0000,2.0000,IDLE',
    ]
    path.write_text(text, encoding="utf-8")
    found = read_csv(path).trajectory
    assert found.step == pytest.approx(1 / 15, abs=1e-4)
    for before, after in zip((a, b), found.tracks, strict=True):
        for name in ("id", "kind", "first_step", "length", "width"):
            assert getattr(after, name) == getattr(before, name)
        for name in ("x", "y", "heading", "speed", "acceleration"):
            assert getattr(after, name) == pytest.approx(getattr(before, name), abs=1e-4), name
