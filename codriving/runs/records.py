"""EpisodeRecord to ``record.json`` and back; a damaged one is named, never guessed at."""

from pathlib import Path

from codriving.datatypes.record import EpisodeRecord
from codriving.errors import RunFolderError
from codriving.runs.strict_json import decode, encode

RECORD = "record.json"


def record_text(record: EpisodeRecord) -> str:
    """Give the content of ``record.json``.

    Raises:
        ValueError: If a value is of the wrong type or not finite.
    """
    return encode(record)


def read_record(folder: Path) -> EpisodeRecord:
    """Read the record of one episode.

    Raises:
        RunFolderError: If it is missing or damaged; nothing is changed on disk.
    """
    path = folder / RECORD
    try:
        return decode(EpisodeRecord, path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise damaged(path, "it is missing") from None
    except OSError as error:
        raise RunFolderError(f"cannot read {path}: {error.strerror}; check its permissions") from error
    except ValueError as error:
        raise damaged(path, str(error)) from error


def damaged(path: Path, reason: str) -> RunFolderError:
    """The error for a file of an episode that cannot be trusted, with its cure."""
    return RunFolderError(
        f"{path} is damaged ({reason}); delete the folder {path.parent} and run again: only this episode is repeated"
    )
