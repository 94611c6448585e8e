"""Processes with closed and full streams, and with variables that other programs set."""

import os
import random
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]

LINES = (
    "run episodes=1 launcher=serial scenario.time_limit=1 run=a",
    "run episodes=2 workers=2 scenario.time_limit=1 run=a",
    "run --cfg",
    "run --episodes 5",
    "list",
    "list scenarios",
    "memory show small.sqlite",
    "memory search crossing --file small.sqlite",
    "replay small --frame 0.5 --out film/a.png",
    "replay small --speed 20 --fps 2 --scale 0.5 --out film/a.mp4",
    "replay small --speed 20 --fps 2 --scale 0.5 --out film/b.gif",
    "check llm=offline",
    "check llm=custom llm.api_base=http://127.0.0.1:9/v1 llm.attempts=1 llm.deadline=2",
    "train nothing",
    "--version",
    "--help",
)

STREAMS = ("", "<&-", ">&-", "2>&-", "<&- >&-", ">&- 2>&-", "<&- >&- 2>&-", ">/dev/full", "2>/dev/full",
">/dev/full 2>&1",
           "| head -1", "</dev/full", ">/dev/null 2>&1 <&-")  # fmt: skip

VARIABLES: tuple[dict[str, str], ...] = (
    {},
    {"HOME": ""},
    {"HOME": "/dev/null/nowhere"},
    {"TMPDIR": "/dev/null/nowhere"},
    {"TMPDIR": "%d"},
    {"TERM": "dumb", "COLUMNS": "0", "LINES": "0"},
    {"COLUMNS": "many", "LINES": "-1", "TERM": ""},
    {"COLUMNS": "1"},
    {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
    {"LC_ALL": "xx_YY.nothing", "LANG": "²"},
    {"PYTHONIOENCODING": "ascii"},
    {"PYTHONIOENCODING": "utf-16"},
    {"NO_COLOR": "1", "FORCE_COLOR": "1", "CLICOLOR_FORCE": "1"},
    {
        "TERMINAL_WIDTH": "x",
        "_TYPER_FORCE_DISABLE_TERMINAL": "x",
        "TYPER_USE_RICH": "x",
        "TYPER_STANDARD_TRACEBACK": "x",
    },
    {"MPLBACKEND": "module://nothing.here"},
    {"MPLBACKEND": "", "MPLCONFIGDIR": "/dev/null"},
    {"MPLCONFIGDIR": "/proc/nothing", "MATPLOTLIBRC": "/dev/null/nowhere"},
    {"SDL_VIDEODRIVER": "nothing", "SDL_AUDIODRIVER": "nothing", "DISPLAY": ":99"},
    {"ALL_PROXY": "socks5://127.0.0.1:1080", "HTTPS_PROXY": "nonsense"},
    {"HTTP_PROXY": "http://127.0.0.1:8", "http_proxy": "::", "NO_PROXY": "[::"},
    {"HTTP_PROXY": "ftp://x", "ALL_PROXY": "%%%"},
    {"SSL_CERT_FILE": "/dev/null/nowhere.pem", "SSL_CERT_DIR": "/dev/null/nowhere"},
    {"SSL_CERT_FILE": "/dev/null", "REQUESTS_CA_BUNDLE": "/dev/null/nowhere"},
    {"OMP_NUM_THREADS": "many", "OPENBLAS_NUM_THREADS": "-1", "MKL_NUM_THREADS": "x"},
    {"HYDRA_FULL_ERROR": "1"},
    {"LITELLM_LOG": "nothing", "LITELLM_MODE": "nothing", "LITELLM_LOCAL_MODEL_COST_MAP": "x", "OPENAI_BASE_URL": "::"},
    {"PYTHONWARNINGS": "error"},
    {"PYTHONWARNINGS": "default"},
    {"PYTHONDEVMODE": "1"},
    {"PYTHONOPTIMIZE": "2"},
    {"PYTHONHASHSEED": "0", "PYTHONUNBUFFERED": "1", "PYTHONSAFEPATH": "1"},
    {"IMAGEIO_FFMPEG_EXE": "/dev/null/nowhere/ffmpeg"},
    {"PATH": ""},
    {"USER": "", "LOGNAME": "", "XDG_CACHE_HOME": "/dev/null", "XDG_CONFIG_HOME": "/dev/null"},
    {"_CODRIVING_COMPLETE": "nothing"},
    {"_CODRIVING_COMPLETE": "complete_bash", "COMP_WORDS": "codriving run sc", "COMP_CWORD": "²"},
    {"TZ": "Nowhere/Nothing"},
    {"GIT_DIR": "/dev/null/nowhere", "GIT_CEILING_DIRECTORIES": "²"},
    {"NUMBA_DISABLE_JIT": "x", "KMP_DUPLICATE_LIB_OK": "x", "FAISS_OPT_LEVEL": "nothing"},
)

QUIET = ("libgomp:", "OMP: ", "MPLCONFIGDIR", "Matplotlib")
"""Beginnings of lines that libraries write themselves."""


@dataclass(frozen=True)
class Surroundings:
    """A process in odd surroundings."""

    line: str
    streams: str
    variables: dict[str, str]

    def fault(self, folder: Path) -> str:
        """Run it in a folder; says what is wrong, nothing if nothing is."""
        path = os.pathsep.join(filter(None, [str(REPOSITORY), os.environ.get("PYTHONPATH")]))
        command = f"{shlex.quote(sys.executable)} -m codriving {self.line}"
        done = subprocess.run(
            ["/bin/sh", "-c", f"{{ {command}; echo $? >code.txt; }} {self.streams}"],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": path, **self.variables},
            capture_output=True,
            timeout=180,
            check=False,
        )
        out, err = (
            done.stdout.decode(errors="replace").replace("\0", ""),
            done.stderr.decode(errors="replace").replace("\0", ""),
        )
        code = int((folder / "code.txt").read_text())
        errors = [text for text in err.splitlines() if text.startswith("error: ")]
        if any(word in err + out for word in ("Traceback", "unforeseen fault", "Exception ignored", "Warning: ")):
            return f"{code}, {err[-600:]!r}"
        if code not in (0, 2, 141) or (code == 2 and len(errors) > 1):
            return f"{code}, {err[-600:]!r}"
        heard = "2>" not in self.streams and not self.line.startswith("--")
        return f"{code} without a line: {err!r}" if code == 2 and heard and len(errors) != 1 else ""


def surroundings(draw: random.Random) -> Surroundings:
    """Draw a line and its surroundings."""
    streams = draw.choice(STREAMS) if draw.random() < 0.6 else ""
    variables = draw.choice(VARIABLES)
    return Surroundings(
        draw.choice(LINES), streams, {**variables, **(draw.choice(VARIABLES) if draw.random() < 0.3 else {})}
    )
