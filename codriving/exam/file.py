"""The file of an exam: compressed lines of JSON, with a hash that is checked when it is read."""

import hashlib
import json
import lzma
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from codriving.errors import ConfigError
from codriving.exam.plain import plain, restored
from codriving.exam.stored import ExamNegotiation, ExamSituation, StoredExam

OURS = Path(__file__).parent / "exam.jsonl.xz"

FORMAT = 1  # Of the file; another one cannot be read

_KINDS = {"situation": ExamSituation, "negotiation": ExamNegotiation}


def written_exam(exam: StoredExam) -> bytes:
    """Write an exam; the same exam is the same bytes."""
    lines = [{"situation": plain(one)} for one in exam.situations]
    lines += [{"negotiation": plain(one)} for one in exam.negotiations]
    text = "".join(f"{_json(line)}\n" for line in [dict(exam.about), *lines])
    head = _json({"exam": FORMAT, "sha256": _hash(text)})
    return lzma.compress(f"{head}\n{text}".encode(), preset=9 | lzma.PRESET_EXTREME)


@lru_cache(maxsize=2)
def read_exam(file: Path = OURS) -> StoredExam:
    """Read an exam.

    Raises:
        ConfigError: If the file cannot be read, is of another format, or is not as it was written.
    """
    try:
        whole = lzma.decompress(file.read_bytes()).decode()
    except (OSError, lzma.LZMAError, UnicodeDecodeError) as error:
        raise ConfigError(f"{file} cannot be read as an exam ({error}); name a file of docs/exam/build.py") from error
    first, _, text = whole.partition("\n")
    head = _mapping(first)
    if head.get("exam") != FORMAT:
        raise ConfigError(f"{file} is no exam of format {FORMAT}; build it again with docs/exam/build.py")
    if head.get("sha256") != (found := _hash(text)):
        raise ConfigError(
            f"{file} is not as it was built: its SHA-256 is {found[:12]}, and {str(head.get('sha256'))[:12]} is "
            "written in it; install it again, or build it with docs/exam/build.py"
        )
    about, *lines = text.splitlines()
    try:
        made = [restored(_KINDS[kind], data) for line in lines for kind, data in json.loads(line).items()]
    except (ValueError, TypeError, KeyError) as error:
        raise ConfigError(
            f"{file} holds a question that this version cannot read ({error!r:.100}); build it again with "
            "docs/exam/build.py"
        ) from error
    situations = tuple(one for one in made if isinstance(one, ExamSituation))
    negotiations = tuple(one for one in made if isinstance(one, ExamNegotiation))
    return replace(StoredExam(situations, negotiations, json.loads(about)), sha256=found)


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
