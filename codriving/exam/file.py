"""The file of an exam: compressed lines of JSON, with a hash that is checked when it is read."""

import hashlib
import json
import lzma
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from codriving.errors import ConfigError
from codriving.exam.plain import plain, restored
from codriving.exam.stored import ExamNegotiation, ExamSituation, StoredExam

OURS = Path(__file__).parent / "exam.jsonl.xz"

FORMAT = 1  # Of the file; another one cannot be read

BUILDER = "docs/exam/build.py"

_KINDS = {"situation": ExamSituation, "negotiation": ExamNegotiation}


def written_exam(exam: StoredExam) -> bytes:
    """Write an exam; the same exam is the same bytes."""
    lines = [{"situation": plain(one)} for one in exam.situations]
    lines += [{"negotiation": plain(one)} for one in exam.negotiations]
    return written_lines("exam", exam.about, lines)


@lru_cache(maxsize=2)
def read_exam(file: Path = OURS) -> StoredExam:
    """Read an exam.

    Raises:
        ConfigError: If the file cannot be read, is of another format, or is not as it was written.
    """
    about, made, found = read_lines("exam", file, _KINDS, BUILDER)
    situations = tuple(one for one in made if isinstance(one, ExamSituation))
    negotiations = tuple(one for one in made if isinstance(one, ExamNegotiation))
    return StoredExam(situations, negotiations, about, found)


def written_lines(what: str, about: Mapping[str, str], lines: Sequence[Mapping[str, Any]]) -> bytes:
    """Write lines, compressed, under a line that says what the file is, and its hash."""
    text = "".join(f"{_json(line)}\n" for line in [dict(about), *lines])
    head = _json({what: FORMAT, "sha256": _hash(text)})
    return lzma.compress(f"{head}\n{text}".encode(), preset=9 | lzma.PRESET_EXTREME)


def read_lines(
    what: str, file: Path, kinds: Mapping[str, type], builder: str
) -> tuple[Mapping[str, str], list[Any], str]:
    """Read what ``written_lines`` has written: about it, the objects of its lines, and its hash.

    Args:
        kinds: The type of each kind of line.
        builder: The script that builds such a file.

    Raises:
        ConfigError: If the file cannot be read, is of another format, or is not as it was written.
    """
    try:
        whole = lzma.decompress(file.read_bytes()).decode()
    except (OSError, lzma.LZMAError, UnicodeDecodeError) as error:
        raise ConfigError(f"{file} cannot be read ({error}); name a file of {builder}") from error
    first, _, text = whole.partition("\n")
    head = _mapping(first)
    if head.get(what) != FORMAT:
        raise ConfigError(f"{file} holds no {what} of format {FORMAT}; build it again with {builder}")
    if head.get("sha256") != (found := _hash(text)):
        raise ConfigError(
            f"{file} is not as it was built: its SHA-256 is {found[:12]}, and {str(head.get('sha256'))[:12]} is "
            f"written in it; restore it, or build it with {builder}"
        )
    about, *lines = text.splitlines()
    try:
        made = [restored(kinds[kind], data) for line in lines for kind, data in json.loads(line).items()]
    except (ValueError, TypeError, KeyError) as error:
        raise ConfigError(
            f"{file} holds a line that this version cannot read ({error!r:.100}); build it again with {builder}"
        ) from error
    return json.loads(about), made, found


def _mapping(line: str) -> Mapping[str, Any]:
    try:
        value = json.loads(line)
    except ValueError:
        return {}
    return value if isinstance(value, dict) else {}


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
