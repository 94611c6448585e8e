"""The end of a file's name says how it is read."""

from pathlib import Path

import pytest

from codriving.errors import RecordingError
from codriving.recordings.read import read_recording


def test_a_file_of_another_kind_is_refused_with_what_is_known() -> None:
    for name in ("a.json", "a", "a.csv.gz", "a.xls"):
        with pytest.raises(RecordingError, match=rf"{name} is no recording that is known; give a \.csv, an \.xml"):
            read_recording(Path(name))


@pytest.mark.parametrize("name", ["a.csv", "a.XML", "a.xml.gz", "a.xlsx"])
def test_a_file_that_is_not_there_is_named(name: str) -> None:
    with pytest.raises(RecordingError, match=rf"cannot read {name}"):
        read_recording(Path(name))
