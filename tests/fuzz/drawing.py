"""Command lines drawn by a seed: every command, with settings that hold and settings that do not."""

import random
import string
from collections.abc import Iterator, Mapping
from functools import cache

from codriving.config import GROUPS, choices, compose
from tests.fuzz.place import YAMLS

SHORT = ("episodes=1", "launcher=serial", "scenario.time_limit=1", "memory.interactions=0")
"""What keeps a line that holds from driving for long; the last one counts for a frozen memory alone."""

GUARDED = ("episodes", "launcher", "scenario.time_limit", "workers", "render")
"""Keys that get no value which holds and takes long."""

PATHS = ("output", "prompts", "llm.prompts", "llm.cache_file", "memory.file", "method.weights")

ODD = (
    "", "²", "\u0661", "1e3", "0x5", "1_0", "inf", "-inf", "nan", "-1", "-0.0", "0", "1" + "0" * 30, "1" + "0" * 400,
    "9" * 5000, "1e400", "1e-400", "true", "null", "[]", "{}", "[1,2]", "[[[]]]", "{a:1}", "{a:{b:[c]}}", "a,b", ",",
    "a,,b", "'",
    '"', "\\", "'a", "(", ")", "[" * 2000, "{a:" * 500, "${x}", "${scenario}", "${oc.env:HOME}", "${", "$x",
    "${.}", "übung", '"übung"', "'a b'", "a b", " ", "\t", "\n", "\x00", "\udcff", "\u202e", "😀", "a" * 300, "-rf",
    "--help", "%d", "%s", "a:b", "a=b", "==", "*", "range(1,3)", "range(3,1)", "range(1,1e9)", "choice()", "glob(*)",
    "shuffle(1,2)", "interval(0,1)", "sort(2,1)", "int(a)", "all", "None", "!!python/name:os.system", "~", "~x",
    "@", "a@b",
)  # fmt: skip

READABLE = (
    "", "1e3", "0x5", "1_0", "inf", "-inf", "nan", "-1", "-0.0", "0", "1" + "0" * 30, "1" + "0" * 400, "1e400",
    "1e-400",
    "true", "null", "[]", "{}", "[1,2]", "[2,1]", "[nan,1]", "[[[]]]", "{a:1}", "a,b", "0,1", "'a'", '"übung"', "'a b'",
    "a b", "a" * 300, "-rf", "%d", "a:b", "range(1,3)", "1e9", "0.5", "3", "2.5", "-0.5", "100000", "[0.1,0.2,0.3]",
    "${scenario.cavs}", "${seed}", "${nothing}", "os.system", "codriving.errors.UserError", "{_target_:os.system,x:1}",
)  # fmt: skip
"""What Hydra takes, so that our own checks have to say something."""

ODD_PATHS = (
    "here", "a/b/c", "..", ".", "/dev/null", "/dev/full", "/proc/self/nothing", "/dev/null/below", "~/x", "~nobody/x",
    "x" * 300, "/".join(["y" * 200] * 25), "'with blank'", '"a\\nb"', "'%d:-'", "-x", "nothing.sqlite", "conf",
    "file.txt",
    "damaged.sqlite", "other.sqlite", "small.sqlite", "loop", "forbidden/x", '"übung"', "''", "null", "3", "[a]",
)  # fmt: skip

WORDS = ("nothing", "all", "null", "intersection", "a b", "²", "", "../x", "config", "_model", "x" * 300)


BASES = ((), ("llm=custom", "llm.api_base=http://127.0.0.1:9/v1"), ("memory=online",), ("method=mcts",),
         ("method=coop_game", "scenario=merge"), ("scenario=highway",), ("scenario=roundabout",
         "method=idfst"))  # fmt: skip
"""Choices under which one key or another is there."""


@cache
def keys() -> tuple[tuple[str, object, tuple[str, ...]], ...]:
    """Every key that a config has, a value that holds, and the choices under which it is there."""
    found: dict[str, tuple[object, tuple[str, ...]]] = {}
    for base in BASES:
        for key, value in _flat(compose(base)):
            if key.startswith(("environment.scenario.", "method.cda.", "method.executor.")):
                continue  # Other names of keys that are here already
            found.setdefault(key, (value, base))
    return tuple((key, *pair) for key, pair in found.items())


def _flat(node: Mapping[str, object], prefix: str = "") -> Iterator[tuple[str, object]]:
    for name, value in node.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


class Drawing:
    """Draws command lines."""

    def __init__(self, draw: random.Random) -> None:
        self.random = draw

    def line(self) -> list[str]:
        """Draw what is typed after ``codriving``."""
        kinds = {
            self._run: 60, self._ablate: 4, self._compare: 5, self._learn: 10, self._build: 8, self._check: 12,
            self._replay: 20, self._pages: 16, self._train: 10, self._list: 6, self._nonsense: 10,
        }  # fmt: skip
        (draw,) = self.random.choices(list(kinds), list(kinds.values()))
        return draw()

    def _few(self) -> list[str]:
        """An odd override, most of the time, among others that hold."""
        plain = [self._plain() for _ in range(self.random.randrange(3))]
        odd = self._odd() if self.random.random() < 0.8 else []
        return [*odd, *plain] if self.random.random() < 0.9 else [*odd, *plain, *self._odd()]

    def _plain(self) -> str:
        if self.random.random() < 0.5:
            group = self.random.choice(["cda", "metrics", "executor"])
            return f"{group}={self.random.choice(list(choices(group)))}"
        key, value, _ = self.random.choice(
            [k for k in keys() if isinstance(k[1], bool | int | float) and k[0] not in GUARDED and not k[2]]
        )
        return f"{key}={str(value).lower()}"

    def _odd(self) -> list[str]:
        kind = self.random.random()
        if kind < 0.08:
            return [f"{self.random.choice(GROUPS)}={self.random.choice(WORDS)}"]
        if kind < 0.25:
            key = self.random.choice(PATHS)
            base = {"llm": BASES[1], "memory": BASES[2], "method": ("method=madqn",)}.get(key.partition(".")[0], ())
            return [*base, f"{key}={self.random.choice(ODD_PATHS)}"]
        key, value, base = self.random.choice(keys())
        if key in PATHS:
            return [*base, f"{key}={self.random.choice(ODD_PATHS)}"]
        if kind < 0.33:
            return [*base, f"{self._mangled(key)}={str(value).lower()}"]
        # What Hydra refuses to read says little about the rest, so it is a third of what is tried.
        odd = READABLE if self.random.random() < 0.67 else ODD
        long = ("1e3", "1_0", "1" + "0" * 30, "100000")
        return [*base, f"{key}={self.random.choice([t for t in odd if key not in GUARDED or t not in long])}"]

    def _plain_or_odd(self) -> list[str]:
        return self._odd() if self.random.random() < 0.4 else []

    def _mangled(self, key: str) -> str:
        how = self.random.randrange(8)
        if how < 3:
            at = self.random.randrange(len(key) + 1)
            return key[:at] + self.random.choice(string.printable + "ü²") + key[at:]
        return [f"+{key}", f"~{key}", f"{key}.x", key.replace(".", ".."), f"{key}@x"][how - 3]

    def _short(self, overrides: list[str]) -> list[str]:
        given = {token.lstrip("+").partition("=")[0] for token in overrides}
        return [*overrides, *(token for token in SHORT[:3] if token.partition("=")[0] not in given)]

    def _cfg(self) -> list[str]:
        return ["--cfg"] if self.random.random() < 0.3 else []

    def _dir(self) -> list[str]:
        if self.random.random() < 0.8:
            return []
        return [
            "--config-dir",
            self.random.choice(["conf", "nowhere", "file.txt", "odd", "plugin", "", "x" * 300, "~"]),
        ]

    def _run(self) -> list[str]:
        if self.random.random() < 0.25:
            name = self.random.choice(list(YAMLS))
            return ["run", "--config-dir", "odd", f"scenario={name}", "episodes=1"]
        return ["run", *self._short(self._few()), *self._cfg(), *self._dir()]

    def _ablate(self) -> list[str]:
        return ["ablate", *self._short(self._few()), "--cfg"]

    def _compare(self) -> list[str]:
        table = self.random.choice(
            ["baselines", "single-vehicle"] * 4 + ["all", "load", "nothing", "", "²", "episodes=1"]
        )
        return ["compare", table, *self._short(self._few()), "--cfg"]

    def _learn(self) -> list[str]:
        count = self.random.choice([*ODD, "0", "0,1", "1,0", "0,0", "-1,2", "20000", "1.5"])
        driven = ["scenario=merge", "cda=full"]
        return ["learn", *driven, f"interactions={count}", *self._few(), *self._short([]), *["--cfg"] * (count != "0")]

    def _build(self) -> list[str]:
        count = self.random.choice([*ODD, "1"]) if self.random.random() < 0.5 else "1"
        shown = [] if count == "1" else ["--cfg"]
        return ["memory", "build", f"interactions={count}", *self._few(), *self._short([])[1:], *shown]

    def _check(self) -> list[str]:
        model = self.random.choice(["offline", "custom", "openai", "anthropic", "gemini", "ollama", "vllm", "nothing"])
        address = self.random.choice(
            ["http://127.0.0.1:9/v1", "http://127.0.0.1:99999/v1", "ftp://x", "http://", "127.0.0.1:9", "http://[::1",
             "http://a b/", "http://user:secret@127.0.0.1:9", "'http://127.0.0.1:9/?a=b'", "http://127.0.0.1:x",
             "''", "null"]
        )  # fmt: skip
        return [
            "check",
            f"llm={model}",
            f"llm.api_base={address}",
            "llm.deadline=1",
            "llm.attempts=1",
            *self._plain_or_odd(),
        ]

    def _replay(self) -> list[str]:
        run = self.random.choice(
            ["small", "outputs/run/small", "outputs", "/", ".", "..", "file.txt", "empty", "nothing", "x" * 300, "",
            "*",
             "[", "**", "~", "outputs/run/small/manifest.json", "loop", "forbidden", "\udcff", "a\x00b", "/dev/null"]
        )  # fmt: skip
        options = {
            "--episode": ["0", "1", "-1", "²", "nan", "1" + "0" * 30, "9" * 5000],
            "--cell": ["", "intersection", "merge", "²", "x" * 300, "../.."],
            "--format": ["mp4", "gif", "avi", "", "²"],
            "--out": ["x.png", "x.mp4", "", "/dev/full/x.png", "x" * 300 + ".png", "-x.png", "conf", "/proc/x.png",
            "~/a.png"],
            "--speed": ["1", "nan", "inf", "0", "-1", "1e400", "x"],
            "--fps": ["5", "nan", "inf", "0", "1e9", "1e-9"],
            "--scale": ["0.5", "nan", "0", "1e9"],
            "--frame": ["0", "0.5", "nan", "-1", "1e9", "inf", "-0.0"],
            "--config-dir": ["conf", "nowhere", "odd"],
        }  # fmt: skip
        if self.random.random() < 0.7:
            run = "small"
        # One picture is drawn sooner than a film.
        name = self.random.choice(list(options))
        words = [] if name == "--frame" else ["--frame", "0.5"] if name not in ("--format", "--speed", "--fps") else []
        return ["replay", run, *words, name, self.random.choice(options[name])]

    def _pages(self) -> list[str]:
        files = ["small.sqlite", "damaged.sqlite", "other.sqlite", "file.txt", "conf", "nothing", "/dev/null",
        "x" * 300,
                 "empty.sqlite", "forbidden/x", "loop", "", "~", "a?mode=rw", "a#b", "%00"]  # fmt: skip
        most = (
            ["--most", self.random.choice(["1", "0", "-1", "1001", "²", "1e3", "5"])]
            if self.random.random() < 0.4
            else []
        )
        match self.random.randrange(3):
            case 0:
                return ["memory", "show", self.random.choice(files), *most]
            case 1:
                text = self.random.choice(
                    ["crossing", "", "²", "9" * 400, "-" + "9" * 400, "a" * 9999, "%", "\udcff", "dTTCP 0.5"]
                )
                return ["memory", "search", text, "--file", self.random.choice(files), *most]
        pair = [self.random.choice(files), self.random.choice(files)]
        out = self.random.choice(
            ["new.sqlite", "small.sqlite", "conf", "x" * 300, "/dev/null/x", "nowhere/x", "forbidden/x", ""]
        )
        same = ["--duplicates", self.random.choice(["0.9", "nan", "2", "²", "1"])] if self.random.random() < 0.4 else []
        return ["memory", "merge", *pair, "--out", out, *same]

    def _train(self) -> list[str]:
        learner = self.random.choice(["madqn", "ppo", "tell", "nothing", "", "²", "../x"])
        family = ["--family", self.random.choice(["junction", "lanes", "nothing", "²", ""])]
        key = self.random.choice(
            ["seed", "decisions", "output", "run", "settings.x", "traffic.0.weight", "traffic.x", "llm", "a"]
        )
        values = ODD_PATHS if key == "output" else ODD
        # A training that could begin would take minutes.
        return [
            "train",
            learner if self.random.random() < 0.3 else "madqn",
            *family,
            f"{key}={self.random.choice(values)}",
            "nothing=0",
        ]

    def _list(self) -> list[str]:
        return [
            "list",
            self.random.choice([*GROUPS, "scenarios", "memories", "nothing", "", "²", "x" * 999]),
            *self._dir(),
        ]

    def _nonsense(self) -> list[str]:
        parts = [*ODD, "run", "memory", "list", "-m", "--episodes", "5", "episodes", "=", "--cfg", "-h",
        "--version", "--file",
                 "--install-completio", "-", "--", "---", "-1", "--episode=²"]  # fmt: skip
        return self.random.choices(parts, k=self.random.randint(1, 4))
