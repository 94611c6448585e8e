"""One command line in this process, and whether it ended as it should: with an exit code and, if refused, one line."""

import contextlib
import io
import os
import re
import tempfile
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path


@contextlib.contextmanager
def quiet_home(home: Path) -> Iterator[None]:
    """Put files for temporary use, a home folder, and what main changes in the environment, where they do no harm."""
    home.mkdir()
    before, folder = dict(os.environ), tempfile.tempdir
    keys = [name for name in os.environ if name.endswith(("_API_KEY", "_TOKEN"))]
    for name in keys:
        del os.environ[name]
    os.environ["HOME"], tempfile.tempdir = str(home), str(home)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)
        tempfile.tempdir = folder


CODES = (0, 1, 2)

FORBIDDEN = re.compile(
    r"Traceback|unforeseen fault|Lexer|Exception\b|HydraException|OmegaConf|Warning:|full_key|Exception ignored"
)
"""What is never on the screen: words of libraries, and unforeseen faults."""


@dataclass(frozen=True)
class Trial:
    """What came of a line."""

    line: tuple[str, ...]
    code: int | None
    out: str
    err: str
    raised: str = ""

    @property
    def fault(self) -> str:
        """What is wrong with it; empty if nothing is."""
        errors = [text for text in self.err.splitlines() if text.startswith("error: ")]
        if self.raised:
            return f"raised {self.raised.strip().splitlines()[-1]}"
        if self.code not in CODES:
            return f"exit code {self.code}"
        if found := FORBIDDEN.search(self.err + self.out.replace("Exception", "")):
            return f"says {found[0]!r}: {self.err[-300:]!r}"
        usage = self.err.startswith("Usage: ")
        if self.code == 2 and not usage and (len(errors) != 1 or not self.err.endswith("\n")):
            return f"{len(errors)} lines of error: {self.err[-300:]!r}"
        if self.code == 2 and not usage and not self.err.splitlines()[-1].startswith("error: "):
            return f"ends without an error: {self.err[-300:]!r}"
        if self.code == 1 and " ended in an error" in self.out:
            return f"episodes failed: {self.out[-400:]!r}"
        return "a very long line" if any(len(text) > 3000 for text in errors) else ""


def tried(line: list[str], folder: Path) -> Trial:
    """Run a line in a folder, in this process."""
    from codriving.cli import main

    out, err, code, raised = io.StringIO(), io.StringIO(), None, ""
    before = Path.cwd()
    os.chdir(folder)
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                main(line)
            except SystemExit as end:
                code = end.code if isinstance(end.code, int) else 0 if end.code is None else None
            except BaseException:
                raised = traceback.format_exc()
    finally:
        os.chdir(before)
    return Trial(tuple(line), code, out.getvalue(), err.getvalue(), raised)
