"""Whether the files of an episode are as they were written, by the list of their SHA-256 that lies beside them.

The list has the form of ``sha256sum``: ``sha256sum -c SHA256SUMS`` checks a folder without this program.
"""

import hashlib
import re
from collections.abc import Mapping
from pathlib import Path

from codriving.datatypes import EpisodeRecord
from codriving.runs.atomic import write_text
from codriving.runs.json_files import damaged, encode, read_episode_bytes, read_episode_text

SUMS = "SHA256SUMS"

RECORD = "record.json"
TRAJECTORY = "trajectory.csv"
DECISIONS = "decisions.jsonl"  # What was shared, negotiated, removed and decided, one line a decision step

_NAME = re.compile(r"\w+\.\w+")


def sums_text(files: Mapping[str, str]) -> str:
    """List the content of files, by name."""
    return "".join(f"{hashlib.sha256(text.encode()).hexdigest()}  {name}\n" for name, text in files.items())


def rewrite_record(folder: Path, record: EpisodeRecord) -> None:
    """Write a record again, with the scores of another metric.

    Raises:
        OSError: If it cannot be written; the former one stays.
    """
    text, sums = encode(record), folder / SUMS
    if not sums.exists():
        write_text(folder / RECORD, text)
        return
    new, old = sums_text({RECORD: text}), sums.read_text(encoding="utf-8")
    # Both are right until the new record is there, so that a kill in between leaves nothing that looks damaged.
    write_text(sums, new + old)
    write_text(folder / RECORD, text)
    write_text(sums, new + "".join(line for line in old.splitlines(True) if not line.endswith(f"  {RECORD}\n")))


def check_files(folder: Path, record: EpisodeRecord) -> None:
    """Refuse an episode whose files are missing or hold something else than what was written.

    Of an episode of release 0.1 there is no list; its files are looked at as far as takes no time.

    Raises:
        DamagedEpisodeError: With the file, and what is wrong with it.
        RunFolderError: If one cannot be read.
    """
    if not (folder / SUMS).exists():
        if record.participants:
            _check_rows(folder / TRAJECTORY, read_episode_text(folder / TRAJECTORY))
        _check_lines(folder / DECISIONS, read_episode_text(folder / DECISIONS), record.decisions)
        return
    listed: dict[str, set[str]] = {}
    for line in read_episode_text(folder / SUMS).splitlines():
        digest, _, name = line.partition("  ")
        listed.setdefault(name, set()).add(digest)
    if not {RECORD, DECISIONS} <= listed.keys() or not all(_NAME.fullmatch(name) for name in listed):
        raise damaged(folder / SUMS, "it is no list of the files of an episode")
    for name, digests in listed.items():
        path = folder / name
        if hashlib.sha256(read_episode_bytes(path)).hexdigest() not in digests:
            raise damaged(path, f"it is not what was written, by {SUMS} beside it")


def _check_rows(path: Path, text: str) -> None:
    """Tell a table that is cut off or is none."""
    rows = text.count("\n")
    if not text.startswith("time,id,kind,") or not text.endswith("\n") or text.count(",") != 8 * rows or rows < 2:
        raise damaged(path, "it is not a whole table")


def _check_lines(path: Path, text: str, lines: int) -> None:
    kept = text.split("\n")[:-1] if text.endswith("\n") else text.split("\n") if text else []
    if len(kept) != lines or not all(line.startswith("{") and line.endswith("}") for line in kept):
        raise damaged(path, f"it does not have one object for each of {lines} decision steps")
