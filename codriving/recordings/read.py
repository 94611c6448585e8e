"""A file to a recording, by the end of its name."""

from pathlib import Path

from codriving.errors import RecordingError
from codriving.recordings.recording import Recording


def read_recording(path: Path) -> Recording:
    """Read the trajectories of a file: .csv, .xml or .xml.gz of SUMO, or .xlsx of the paper's authors.

    Raises:
        RecordingError: If it cannot be read, in one line with file, sheet and column.
    """
    suffix = path.with_suffix("").suffix.lower() if path.suffix.lower() == ".gz" else path.suffix.lower()
    if suffix == ".csv" and path.suffix.lower() != ".gz":
        from codriving.recordings.csv_file import read_csv

        return read_csv(path)
    if suffix == ".xml":
        from codriving.recordings.fcd import read_fcd

        return read_fcd(path)
    if suffix == ".xlsx":
        from codriving.recordings.workbook import read_workbook

        return read_workbook(path)
    raise RecordingError(
        f"{path} is no recording that is known; give a .csv, an .xml or .xml.gz of SUMO's --fcd-output, or an .xlsx"
    )
