"""Files and folders that are there whole or not at all, also after SIGKILL or a power cut."""

import os
import shutil
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

PARTIAL = ".partial-"  # Prefix of everything unfinished; a leading dot keeps it out of listings


def _partial(path: Path) -> Path:
    """A fresh name beside ``path``: renaming is atomic only within one file system."""
    return path.parent / f"{PARTIAL}{path.name}-{uuid.uuid4().hex[:12]}"


def _sync(path: Path) -> None:
    """Push a file or folder to the disk itself, so that a rename never runs ahead of its content."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def write_text(path: Path, text: str) -> None:
    """Write a file so that a reader sees the old content or the new, never a part.

    Raises:
        OSError: If the file cannot be written; nothing is left behind.
    """
    with whole_file(path) as partial:
        partial.write_text(text, encoding="utf-8", newline="")


@contextmanager
def whole_file(path: Path, beside: Path | None = None) -> Iterator[Path]:
    """Give a name to write a file under, which takes the place of ``path`` once the block has ended well.

    Raises:
        OSError: If it cannot be written; nothing is left behind and an existing ``path`` stays.
    """
    partial = _partial((beside or path.parent) / path.name)
    try:
        yield partial
        _sync(partial)
        partial.replace(path)
        _sync(path.parent)
    finally:
        partial.unlink(missing_ok=True)


@contextmanager
def whole_folder(path: Path) -> Iterator[Path]:
    """Give a folder to fill, which takes the place of ``path`` once the block has ended well.

    Raises:
        OSError: If it cannot be written; nothing is left behind and an existing ``path`` stays.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = _partial(path)
    partial.mkdir()
    try:
        yield partial
        for item in partial.iterdir():
            _sync(item)
        _sync(partial)
        former = _partial(path)
        if path.exists():
            path.rename(former)
        partial.rename(path)
        shutil.rmtree(former, ignore_errors=True)
        _sync(path.parent)
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def sweep(folder: Path) -> None:
    """Remove what a killed run left unfinished directly in a folder."""
    for item in folder.glob(f"{PARTIAL}*"):
        if item.is_dir() and not item.is_symlink():
            shutil.rmtree(item, ignore_errors=True)
            continue
        # What cannot be removed stays; a folder that cannot be written is told where something has to be written.
        with suppress(OSError):
            item.unlink(missing_ok=True)
