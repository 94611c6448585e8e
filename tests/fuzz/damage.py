"""Files that are damaged, and the command lines that read them."""

import random
import re
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing, suppress
from pathlib import Path

EPISODE = "outputs/run/small/episodes/intersection-codriving-full/0"

_RUN = ["run", "output=outputs", "run=small", "episodes=1", "launcher=serial", "scenario.time_limit=2"]
_SHOWN = ["replay", "small", "--frame", "0.5"]
_FROZEN = ["run", "memory=frozen", "memory.file=small.sqlite", "episodes=1", "launcher=serial", "scenario.time_limit=1"]
_ONLINE = ["run", "memory=online", "memory.file=small.sqlite", "episodes=1", "launcher=serial", "scenario.time_limit=1"]
_OTHER = ["memory", "merge", "small.sqlite", "whole.sqlite", "--out", "both.sqlite"]
_LEARNED = [
    "run",
    "method=madqn",
    "method.weights=weights.safetensors",
    "episodes=1",
    "launcher=serial",
    "scenario.time_limit=1",
]
_REPLAYED = ["run", "llm=custom", "llm.api_base=http://127.0.0.1:9/v1", "llm.cache=replay",
"llm.cache_file=answers.sqlite",
             "episodes=1", "launcher=serial", "scenario.time_limit=1"]  # fmt: skip
_YAML = ["run", "--cfg", "--config-dir", "mine", "scenario=mine"]

# What is damaged, and what reads it.
READERS: dict[str, tuple[list[str], ...]] = {
    "outputs/run/small/manifest.json": (_SHOWN, _RUN),
    f"{EPISODE}/record.json": (_SHOWN, _RUN),
    f"{EPISODE}/decisions.jsonl": (_SHOWN, _RUN),
    f"{EPISODE}/trajectory.csv": (_SHOWN, _RUN),
    f"{EPISODE}/timing.json": (_SHOWN, _RUN),
    "outputs/run/small/config.yaml": (_SHOWN, _RUN),
    "outputs/run/small/episodes.csv": (_SHOWN, _RUN),
    "small.sqlite": (["memory", "show", "small.sqlite"], ["memory", "search", "crossing", "--file", "small.sqlite"],
                     _OTHER, _FROZEN, _ONLINE),
    "mine/scenario/mine.yaml": (_YAML, ["list", "scenarios", "--config-dir", "mine"]),
    "mine/train/madqn_lanes.yaml": (["train", "madqn", "--family", "lanes", "--config-dir", "mine", "nothing=0"],),
    "prompts/decide.system.md.j2": (["run", "--cfg", "prompts=prompts", "llm=custom",
    "llm.api_base=http://127.0.0.1:9/v1"],),
    "answers.sqlite": (_REPLAYED,),
    "weights.safetensors": (_LEARNED,),
    "weights.json": (_LEARNED,),
}  # fmt: skip

VALUES = (b"null", b"-1", b"1e999", b"NaN", b"Infinity", b"1" + b"0" * 400, b'"text"', b"[]", b"{}", b"true", b'""',
b"0",
          b'"\\ud800"', b'"\\u0000"', b"0.5", b"[[1]]", b"9" * 5000, b'"' + b"x" * 5000 + b'"')  # fmt: skip


def damaged_file(draw: random.Random, folder: Path) -> tuple[str, str, list[str]]:
    """Damage one file of a folder.

    Returns:
        Its name, how it was damaged, and the command line that reads it.
    """
    name = draw.choice([name for name, readers in READERS.items() for _ in readers])
    path = folder / name
    if name.endswith(".sqlite") and draw.random() < 0.6:
        how = _in_database(draw, path)
    else:
        ways = [
            _cut,
            _flip,
            _zeros,
            _noise,
            _values,
            _values,
            _values,
            _encoding,
            _lines,
            _twice,
            _deep,
            _emptied,
            _folder,
        ]
        way: Callable[[random.Random, Path], None] = draw.choice(ways)
        how = way.__name__
        way(draw, path)
    return name, how, list(draw.choice(READERS[name]))


def _cut(draw: random.Random, path: Path) -> None:
    whole = path.read_bytes()
    path.write_bytes(whole[: draw.randrange(len(whole))])


def _flip(draw: random.Random, path: Path) -> None:
    content = bytearray(path.read_bytes())
    for _ in range(draw.choice([1, 3, 30])):
        content[draw.randrange(len(content))] ^= 1 << draw.randrange(8)
    path.write_bytes(content)


def _zeros(draw: random.Random, path: Path) -> None:
    content = path.read_bytes()
    at = draw.randrange(len(content))
    path.write_bytes(content[:at] + bytes(draw.choice([1, 500])) + content[at:])


def _noise(draw: random.Random, path: Path) -> None:
    path.write_bytes(draw.randbytes(draw.choice([1, 100, 5000])))


def _values(draw: random.Random, path: Path) -> None:
    """Put another value, or none, in the place of one or two."""
    content = path.read_bytes()
    for _ in range(draw.choice([1, 2])):
        places = list(re.finditer(rb'(?<=[:,\[ ])(-?[0-9.]+|"[^"\n]*"|true|false|null|[a-z_]+)(?=[,\]}\n\r])', content))
        if not places:
            return
        place = draw.choice(places)
        content = content[: place.start()] + draw.choice(VALUES) + content[place.end() :]
    path.write_bytes(content)


def _encoding(draw: random.Random, path: Path) -> None:
    content = path.read_bytes()
    match draw.randrange(4):
        case 0:
            path.write_bytes(b"\xef\xbb\xbf" + content)
        case 1:
            path.write_bytes(content.decode("latin-1").encode("utf-16"))
        case 2:
            path.write_bytes(content.replace(b"\n", b"\r\n"))
        case _:
            path.write_bytes(content.replace(b"e", b"\xe9", 3))


def _lines(draw: random.Random, path: Path) -> None:
    """Lose a line, double one, or put them in another order."""
    lines = path.read_bytes().split(b"\n")
    at = draw.randrange(len(lines))
    match draw.randrange(3):
        case 0:
            del lines[at]
        case 1:
            lines.insert(at, lines[draw.randrange(len(lines))])
        case _:
            draw.shuffle(lines)
    path.write_bytes(b"\n".join(lines))


def _twice(draw: random.Random, path: Path) -> None:
    path.write_bytes(path.read_bytes() * 2)


def _deep(draw: random.Random, path: Path) -> None:
    deep = draw.choice([b"[" * 50_000 + b"]" * 50_000, b'{"a":' * 50_000 + b"1" + b"}" * 50_000, b"- " * 5000 + b"1"])
    content = path.read_bytes()
    path.write_bytes(draw.choice([deep, content.replace(b": ", b": " + deep + b", ", 1), content + deep]))


def _emptied(draw: random.Random, path: Path) -> None:
    path.write_bytes(b"")


def _folder(draw: random.Random, path: Path) -> None:
    path.unlink()
    if draw.random() < 0.5:
        path.mkdir()
    elif draw.random() < 0.5:
        path.symlink_to("nothing")


def _in_database(draw: random.Random, path: Path) -> str:
    """Change what a database holds, by way of SQL."""
    with closing(sqlite3.connect(path, isolation_level=None)) as connection:
        connection.execute("PRAGMA writable_schema = ON")
        tables = [row[0] for row in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        table = draw.choice(tables)
        columns = [row[1] for row in connection.execute(f"PRAGMA table_info({table})")]
        column = draw.choice(columns)
        values = ["NULL", "-1", "1e999", "'text'", "x'00ff'", "''", "'[]'", "'{}'", "'1'", "9223372036854775807", "0.5",
                  f"'{'[' * 3000}'", "'{\"a\": null}'", "zeroblob(7)", "'nan'", "'²'", "'-5'", "'99999999999999999999'",
                  f"'{'9' * 5000}'", "char(0)"]  # fmt: skip
        change = draw.choice(
            [f"UPDATE OR IGNORE {table} SET {column} = {draw.choice(values)}"] * 6
            + [f"UPDATE OR IGNORE {table} SET {column} = {draw.choice(values)} WHERE rowid = 1"]
            + [f"DROP TABLE {table}", f"DELETE FROM {table}", f"ALTER TABLE {table} RENAME COLUMN {column} TO other",
               f"ALTER TABLE {table} ADD COLUMN more", "PRAGMA user_version = 99", "PRAGMA application_id = 5"]
        )  # fmt: skip
        with suppress(sqlite3.Error):
            connection.execute(change)
    return change[:100]


def make_files(folder: Path) -> None:
    """Add to a place what can be damaged beyond what is there."""
    from codriving.config import conf_dir
    from codriving.llm.cache import open_to_write

    package = conf_dir().parent / "codriving"
    shutil.copy(folder / "small.sqlite", folder / "whole.sqlite")
    for folders in ("mine/scenario", "mine/train", "prompts"):
        (folder / folders).mkdir(parents=True)
    shutil.copy(conf_dir() / "scenario" / "merge.yaml", folder / "mine" / "scenario" / "mine.yaml")
    shutil.copy(conf_dir() / "train" / "madqn_lanes.yaml", folder / "mine" / "train")
    for file in (package / "llm" / "prompts" / "planner").glob("*.j2"):
        shutil.copy(file, folder / "prompts")
    for suffix in (".safetensors", ".json"):
        shutil.copy(
            package / "methods" / "learned" / "weights" / "default" / f"madqn_junction{suffix}",
            folder / f"weights{suffix}",
        )
    with closing(open_to_write(folder / "answers.sqlite")) as connection:
        connection.execute("INSERT INTO answers VALUES ('a', '{}')")
        connection.execute("PRAGMA journal_mode = DELETE")
