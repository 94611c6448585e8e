"""What went wrong, in one line: mistakes of the user's, failures of the file system, and what is left."""

import errno
import os
import re
import sys
import sysconfig
import tempfile
import traceback
from pathlib import Path

from typer.exceptions import TyperException

from codriving.config import GROUPS, ROOT
from codriving.version import __version__

_OURS = Path(__file__).resolve().parent.parent
_INSTALLED = [Path(sysconfig.get_path(name)).resolve() for name in ("stdlib", "platstdlib", "purelib", "platlib")]

_SECRET = re.compile(r"key|token|secret|password|credential", re.IGNORECASE)

_ELSEWHERE = "name another place"
_CURES = {
    errno.ENAMETOOLONG: "give it a shorter name, or take a folder with a shorter path",
    errno.ENOSPC: "make room, or name a place on another disk",
    errno.EDQUOT: "make room, or name a place on another disk",
    errno.EFBIG: "make room, or name a place on another disk",
    errno.EMFILE: "let a process open more files (ulimit -n)",
    errno.ENFILE: "let a process open more files (ulimit -n)",
    errno.EACCES: f"change its permissions, or {_ELSEWHERE}",
    errno.EPERM: f"change its permissions, or {_ELSEWHERE}",
    errno.EIO: f"check the disk, or {_ELSEWHERE}",
    **dict.fromkeys((errno.EROFS, errno.ELOOP, errno.EEXIST, errno.EINVAL, errno.EBUSY, errno.ESTALE), _ELSEWHERE),
    **dict.fromkeys((errno.ENOENT, errno.ENOTDIR, errno.EISDIR), _ELSEWHERE),
}


def one_line(error: Exception, args: list[str]) -> str:
    """Say what went wrong."""
    if isinstance(error, TyperException):
        return _of_usage(error, args)
    if isinstance(error, OSError) and error.filename is not None and error.errno in _CURES:
        name = os.fsdecode(error.filename) if isinstance(error.filename, str | bytes) else error.filename
        return f"{name:.300}: {error.strerror}; {_CURES[error.errno]}"
    return _unforeseen(error)


def _of_usage(error: TyperException, args: list[str]) -> str:
    """Mistakes in options; a setting written as one, as other programs have it, is shown as it is written here."""
    option = getattr(error, "option_name", "")
    key = option.lstrip("-").replace("-", "_")
    if option in ("-m", "--multirun"):
        return f"{option} is not needed: values with commas make a sweep, for instance scenario=intersection,merge"
    if key.partition(".")[0] in (*ROOT, *GROUPS):
        place = next((k for k, arg in enumerate(args) if arg.partition("=")[0] == option), len(args))
        given = "".join(args[place : place + 1]).partition("=")[2] or "".join(args[place + 1 : place + 2])
        example = f"{key}={given or '<value>'}"
        return f"{option} is not an option; settings are written without dashes: {example}; commas make a sweep"
    command = getattr(getattr(error, "ctx", None), "command_path", "codriving")
    return f"{error.format_message().rstrip('.'):.300}; {command} --help shows what there is"


def _unforeseen(error: Exception) -> str:
    """An unforeseen fault of a plug-in or of this program, whose traceback goes into a file."""
    text = _scrubbed("".join(traceback.format_exception(error)))
    try:
        handle, name = tempfile.mkstemp(prefix="codriving-fault-", suffix=".txt", text=True)
        os.close(handle)
        head = f"codriving {__version__}, Python {sys.version.split()[0]}\n"
        Path(name).write_text(head + text, encoding="utf-8", errors="backslashreplace")
        where = f"its traceback is in {name}"
    except OSError as no_room:
        where = f"no place was found for its traceback ({no_room.strerror})"
    what = f"{type(error).__name__}: {_scrubbed(str(error))[:300]}".rstrip(": ")
    if (place := _plugin(error)) is not None:
        return f"the plug-in {place} failed ({what}); {where}: mend the plug-in"
    return f"unforeseen fault of codriving ({what}); {where}: please report it with that file and the command"


def _scrubbed(text: str) -> str:
    """Take out the values of environment variables that may hold secrets: a plug-in may quote what it read."""
    secrets = [value for name, value in os.environ.items() if _SECRET.search(name) and len(value) >= 8]
    for secret in sorted(secrets, key=len, reverse=True):
        text = text.replace(secret, "<redacted>")
    return text


def _plugin(error: Exception) -> str | None:
    """The place in a user's own file where an error began; None if none had a part in it."""
    if isinstance(error, SyntaxError) and error.filename and _is_users(error.filename):
        return f"{error.filename}:{error.lineno}"
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if _is_users(frame.filename)]
    return f"{frames[-1].filename}:{frames[-1].lineno}" if frames else None


def _is_users(name: str) -> bool:
    path = Path(name)
    return path.is_absolute() and not any(folder in path.resolve().parents for folder in (_OURS, *_INSTALLED))
