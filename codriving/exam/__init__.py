"""Stored situations and negotiations with what came of every answer: built by driving on, asked without driving."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from codriving.exam.building import FIRST, LAST
    from codriving.exam.chats import of_decisions, of_transcript
    from codriving.exam.file import OURS, read_exam
    from codriving.exam.marks import mark
    from codriving.exam.moments import SEEDS
    from codriving.exam.sitting import Answered, sit, some

__all__ = [
    "FIRST",
    "LAST",
    "OURS",
    "SEEDS",
    "Answered",
    "mark",
    "of_decisions",
    "of_transcript",
    "read_exam",
    "sit",
    "some",
]

_FILES = {
    "building": ("FIRST", "LAST"),
    "chats": ("of_decisions", "of_transcript"),
    "file": ("OURS", "read_exam"),
    "marks": ("mark",),
    "moments": ("SEEDS",),
    "sitting": ("Answered", "sit", "some"),
}


def __getattr__(name: str) -> object:
    """Import a file with the first use of a name in it: who is asked needs no world."""
    for file, names in _FILES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{file}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
