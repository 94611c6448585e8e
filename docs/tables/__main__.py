"""Makes the tables of README.md and some pages: `make tables`, `python docs/tables [--pages | --check] [RUN ...]`.

`tables.yaml` names for each table the commands that drive its episodes and what its columns show. The commands are run
(what is driven already is not driven again), the `summary.csv` of each run folder, `comparison.csv` or `stress.csv`, is
kept beside this file, with the command and the versions that made it, and pages and figures are made from these files
alone.
"""

import argparse
import csv
import io
import json
import re
import shlex
import string
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import yaml

from codriving.runs import BEHAVIOUR
from codriving.version import __version__

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
PAGES = ("README.md", "docs/results.md", "docs/stress.md")
BENCH = "bench "  # How a command begins that is a benchmark
COMPARE = "compare "  # And one that compares, whose table has more columns
STRESS = "stress "  # And one whose rows are the levels of curves
KEYS = ("scenario", "method", "variant")  # What tells the rows of a run apart; rows of several runs are joined by them
# Columns that hold names
WORDS = (*KEYS, "suite", "status", "axis", "level", "value", "success_breaks_at", "clean_breaks_at")
BEGIN, END = "<!-- table {}: made by make tables -->", "<!-- end of table {} -->"
TABLE = re.compile(r"<!-- table (?P<name>[\w-]+): made by make tables -->\n.*?<!-- end of table (?P=name) -->", re.S)


Value = float | str | None


class TableError(Exception):
    """A table that cannot be made; the message says why."""


@dataclass(frozen=True)
class Numbers:
    """The rows of one run, and what made them."""

    command: str
    version: str
    behaviour: int
    rows: tuple[Mapping[str, Value], ...]

    @property
    def shown(self) -> str:
        """The command as it is typed."""
        if not self.command.startswith(BENCH):
            return f"codriving {self.command}"
        return f'make bench ARGS="{self.command.removeprefix(BENCH)}"'

    @classmethod
    def read(cls, file: Path) -> "Numbers":
        """Read what was kept of a run: a line that says what made it, then its ``summary.csv``."""
        try:
            first, *rest = file.read_text(encoding="utf-8").splitlines()
        except OSError as error:
            raise TableError(f"{file} is not there: make tables drives and writes it ({error.strerror})") from error
        made = json.loads(first.removeprefix("# "))
        return cls(made["command"], made["version"], made["behaviour"], tuple(map(_typed, csv.DictReader(rest))))


def _typed(row: Mapping[str, str]) -> dict[str, Value]:
    return {key: text if key in WORDS else _number(text) for key, text in row.items()}


def _number(text: str) -> Value:
    try:
        return float(text)
    except ValueError:
        return text or None


class Cells(string.Formatter):
    """Fills in a cell: a rate of the form ``%`` in percent, and nothing where a number is missing."""

    def get_value(self, key: int | str, args: Sequence[Any], kwargs: Mapping[str, Any]) -> object:
        """Return a key of the row, or the numbers of a run."""
        return kwargs[str(key)]

    def format_field(self, value: object, form: str) -> str:
        """Write a number; after a question mark stands, as of ``%``, what is left out where there is none."""
        if form.startswith("?"):
            return "" if value is None else form[1:] % value
        if value is None:
            raise LookupError
        return f"{100 * value:.3g} %" if form == "%" and isinstance(value, float) else format(value, form)

    def cell(self, template: str, row: Mapping[str, Any]) -> str:
        """Fill in a template."""
        try:
            return self.format(template, **row)
        except (LookupError, AttributeError):
            return ""


def joined(
    worlds: Mapping[str, Sequence[Numbers]], only: Mapping[str, str], keys: Sequence[str]
) -> Iterator[dict[str, Any]]:
    """Yield a row for each combination of keys, with its numbers in each world below the name of that."""
    rows: dict[tuple[str, ...], dict[str, Any]] = {}
    for name, runs in worlds.items():
        for row in (row for run in runs for row in run.rows):
            key = tuple(str(row[k]) for k in keys)
            if all(str(row[k]) in wanted.split(",") for k, wanted in only.items()):
                line = rows.setdefault(key, dict(zip(keys, key, strict=True)))
                if name in line:
                    raise TableError(f"{name} has two rows {', '.join(key)}: take some of the run, or add a key to by:")
                line[name] = SimpleNamespace(**row)
    yield from rows.values()


def rows_of(run: str) -> Numbers:
    """Read the rows of a run; after a blank may stand what they have, or have not: ``hard suite=crowd method!=ppo``."""
    name, *wanted = run.split()
    numbers = Numbers.read(HERE / f"{name}.csv")
    pairs = [text.partition("=")[::2] for text in wanted]
    return replace(numbers, rows=tuple(r for r in numbers.rows if all(_has(r, k, v) for k, v in pairs)))


def _has(row: Mapping[str, Value], key: str, value: str) -> bool:
    return (str(row.get(key.removesuffix("!"))) == value) != key.endswith("!")


def worlds_of(spec: Mapping[str, Any]) -> dict[str, list[Numbers]]:
    """Read the runs of a table, by world."""
    return {world: [rows_of(run) for run in runs] for world, runs in spec["runs"].items()}


def shown_rows(worlds: Mapping[str, Sequence[Numbers]], spec: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the rows that a table shows."""
    return joined(worlds, spec.get("only", {}), spec.get("by", KEYS))


def markdown(name: str, spec: Mapping[str, Any]) -> str:
    """Write a table with the commands and versions that made it, between its two marks."""
    worlds, columns, cells = worlds_of(spec), spec["columns"], Cells()
    found = [[cells.cell(template, row) for template in columns.values()] for row in shown_rows(worlds, spec)]
    if not found:
        raise TableError(f"table {name} has no rows: look at its runs and at only: in tables.yaml")
    found += [list(map(str, line)) for line in spec.get("more", [])]
    align = ["---" if "." not in template else "---:" for template in columns.values()]
    lines = [f"| {' | '.join(line)} |" for line in (list(columns), *found)]
    lines.insert(1, f"|{'|'.join(align)}|")
    used = [run for runs in worlds.values() for run in runs]
    made = list(dict.fromkeys(f"`{run.shown}` (version {run.version}, behaviour {run.behaviour})" for run in used))
    text = "\n".join((BEGIN.format(name), *lines, "", *_sentences(made), END.format(name)))
    return re.sub(" +[|]", " |", text)


def draw(name: str, spec: Mapping[str, Any], file: Path) -> None:
    """Draw the figure of a table from the rows that it shows."""
    from figure import drawn  # Beside this file

    worlds = worlds_of(spec)
    file.write_bytes(drawn(list(shown_rows(worlds, spec)), list(worlds)))


def _sentences(made: Sequence[str]) -> list[str]:
    return [f"From {made[0]}."] if len(made) == 1 else ["From", "", *(f"- {one}" for one in made)]


def drive(run: str, command: str) -> None:
    """Run a command in the root, resuming its folder, and keep its summary; or a benchmark, and keep its rows."""
    if command.startswith(BENCH):
        words = [sys.executable, "-m", "benchmarks", *shlex.split(command.removeprefix(BENCH)), "--json"]
        bench = subprocess.run(words, cwd=ROOT, check=False, stdout=subprocess.PIPE, text=True)
        if bench.returncode:
            raise TableError(f"{command} ended with {bench.returncode}")
        made = {"command": command, "version": __version__, "behaviour": BEHAVIOUR}
        keep(HERE / f"{run}.csv", made, wide([json.loads(line) for line in bench.stdout.splitlines()]))
        return
    words = [*shlex.split(command), f"run=tables-{run}"]
    done = subprocess.run([sys.executable, "-m", "codriving", *words], cwd=ROOT, check=False)
    if done.returncode:
        raise TableError(f"codriving {command} ended with {done.returncode}")
    folders = [path.parent for path in (ROOT / "outputs").glob(f"*/tables-{run}/manifest.json")]
    if len(folders) != 1:
        raise TableError(f"expected one folder outputs/*/tables-{run}, found {len(folders)}")
    manifest = json.loads((folders[0] / "manifest.json").read_text(encoding="utf-8"))
    made = {"command": command, "version": manifest["versions"]["codriving"], "behaviour": manifest["behaviour"]}
    if command.startswith(STRESS):
        levels, curves = ((folders[0] / name).read_text(encoding="utf-8") for name in ("stress.csv", "breaking.csv"))
        keep(HERE / f"{run}.csv", made, with_breaking(levels, curves))
        return
    table = "comparison.csv" if command.startswith(COMPARE) else "summary.csv"
    keep(HERE / f"{run}.csv", made, (folders[0] / table).read_text(encoding="utf-8"))


def wide(rows: Iterable[Mapping[str, Value]]) -> str:
    """Write the rows of a benchmark, one a scenario and world, as CSV with one row a scenario."""
    found: dict[Value, dict[str, Value]] = {}
    for row in rows:
        of = found.setdefault(row["scenario"], {"scenario": row["scenario"], "method": "codriving", "variant": ""})
        of |= {f"{row['world']}_{key}": value for key, value in row.items() if key not in ("scenario", "world")}
    text = io.StringIO()
    writer = csv.DictWriter(text, list(next(iter(found.values()))), lineterminator="\n")
    writer.writeheader()
    writer.writerows(found.values())
    return text.getvalue()


def with_breaking(levels: str, curves: str) -> str:
    """Write the rows of levels, each with the breaking points of its curve, as CSV."""
    breaking = list(csv.DictReader(io.StringIO(curves)))
    points = ["success_breaks_at", "clean_breaks_at"]
    curve = [key for key in breaking[0] if not key.startswith(("success_", "clean_"))]
    found = {tuple(row[key] for key in curve): {key: row[key] for key in points} for row in breaking}
    rows = [row | found[tuple(row[key] for key in curve)] for row in csv.DictReader(io.StringIO(levels))]
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def keep(file: Path, made: Mapping[str, str | int], text: str) -> None:
    """Keep a summary, below the line that says what made it."""
    file.write_text(f"# {json.dumps(made)}\n{text}", encoding="utf-8", newline="\n")


def rewritten(page: str, tables: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the text of a page with each of its tables made again."""

    def table(found: re.Match[str]) -> str:
        name = found["name"]
        if name not in tables:
            raise TableError(f"{page} has a table {name!r}, but tables.yaml does not; it has {', '.join(tables)}")
        return markdown(name, tables[name])

    return TABLE.sub(table, (ROOT / page).read_text(encoding="utf-8"))


def main(arguments: Sequence[str]) -> int:
    """Drive, write the pages, or check them; returns the exit status."""
    parser = argparse.ArgumentParser(prog="make tables", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("runs", nargs="*", metavar="NAME", help="drive these runs alone; otherwise all")
    parser.add_argument("--pages", action="store_true", help="drive nothing, write the pages from the files kept")
    parser.add_argument("--check", action="store_true", help="drive and write nothing, say which pages are not so made")
    chosen = parser.parse_args(arguments)
    spec = yaml.safe_load((HERE / "tables.yaml").read_text(encoding="utf-8"))
    try:
        if unknown := [name for name in chosen.runs if name not in spec["runs"]]:
            raise TableError(f"no run {', '.join(unknown)} in tables.yaml; it has {', '.join(spec['runs'])}")
        if not (chosen.pages or chosen.check):
            for run in chosen.runs or spec["runs"]:
                drive(run, spec["runs"][run])
        stale = []
        for page in PAGES:
            text = rewritten(page, spec["tables"])
            if text != (ROOT / page).read_text(encoding="utf-8"):
                stale.append(page)
                if not chosen.check:
                    (ROOT / page).write_text(text, encoding="utf-8", newline="\n")
        for name, file in spec.get("figures", {}).items() if not chosen.check else ():
            draw(name, spec["tables"][name], ROOT / file)
    except TableError as error:
        print(error, file=sys.stderr)
        return 1
    if chosen.check and stale:
        print(f"not as make tables writes them: {', '.join(stale)}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
