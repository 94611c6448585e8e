"""trajectory.csv: columns, order, decimals."""

import numpy as np
import pytest

from codriving.datatypes.trajectory import Track, Trajectory
from codriving.datatypes.vehicle import Kind
from codriving.storage.trajectory_file import trajectory_text


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


def test_nobody_gives_the_header_alone() -> None:
    assert trajectory_text(Trajectory(0.1, ())) == "time,id,kind,x,y,heading,speed,acceleration,action\n"


def test_a_position_that_is_not_finite_is_refused() -> None:
    with pytest.raises(ValueError, match="CAV1 holds a value that is not finite"):
        trajectory_text(Trajectory(0.1, (track("CAV1", Kind.CAV, 0, [0, np.nan], "IDLE"),)))
