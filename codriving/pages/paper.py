"""The page of the paper's tables and figures driven again: ours in each cell, the paper's below it, and links."""

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from codriving.pages.figures import figures
from codriving.pages.page import HERE, style_hash
from codriving.pages.paper_figures import learning_lines, success_bars
from codriving.pages.parting import choices_in, parting
from codriving.pages.subject import ReportedRow, ReportedRun
from codriving.reports import CellResults
from codriving.runs import read_decisions
from codriving.version import __version__

Numbers = Sequence[Mapping[str, str]]  # The rows of a CSV with the paper's numbers


@dataclass(frozen=True, slots=True)
class AgainstPaper:
    """A number of ours, and what the paper says in its place."""

    ours: str
    theirs: str = ""
    agrees: bool | None = None  # Whether ours is as the paper says; None where that cannot be told


@dataclass(frozen=True, slots=True)
class ShownTable:
    """A table of ours beside the paper's."""

    head: str
    columns: Sequence[str]
    rows: Sequence[tuple[str, Sequence[AgainstPaper]]]


@dataclass(frozen=True, slots=True)
class Case:
    """One start that was driven twice."""

    seed: int
    differing: int  # Starts that end differently
    starts: int
    good: ReportedRow  # With what the case is about
    bad: ReportedRow  # And without it
    names: tuple[str, str]  # What the paper's rows of good and bad are called
    time: float | None  # When they part [s]
    change: str  # Who decides what then


@dataclass(frozen=True, slots=True)
class PaperPart:
    """A table or figure of the paper."""

    name: str  # Of the experiment
    shows: str  # Of the paper
    sentence: str
    kind: str  # ``ablation``, ``learning``, ``comparison`` or ``case``
    command: str
    numbers: Numbers
    run: ReportedRun | None = None  # None where it is not driven yet
    links: Sequence[tuple[str, str]] = ()  # Words and address of what is beside the page
    case: Case | None = None
    frames: Sequence[tuple[str, str, bytes]] = ()  # Row, moment and PNG of each picture


def paper_page(parts: Sequence[PaperPart], command: str) -> str:
    """Make the page.

    Args:
        command: What makes it.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    style = "".join((HERE / name).read_text(encoding="utf-8") for name in ("page.css", "paper.css"))
    rows = [row for part in parts if part.run for row in part.run.rows]
    runs = [part.run for part in parts if part.run]
    values = {
        "version": __version__,
        "policy": f"default-src 'none'; style-src '{style_hash(style)}'; img-src data:; base-uri 'none'; "
        "form-action 'none'",
        "style": style,
        "command": command,
        "models": sorted({row.cell.reasoner for row in rows} - {"rules", "none"}),
        "seeds": sorted({len(row.episodes) for row in rows}),
        "episodes": sum(len(row.episodes) for row in rows),
        "behaviour": sorted({run.manifest.behaviour for run in runs}),
        "commits": sorted({run.manifest.commit[:12] for run in runs if run.manifest.commit}),
        "parts": [_part(part) for part in parts],
        "missing": [part.shows for part in parts if part.run is None],
    }
    environment = Environment(
        loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.get_template("paper.html.j2").render(values)


def _part(part: PaperPart) -> dict[str, Any]:
    made = {"ablation": _ablation, "learning": _learning, "comparison": _comparison, "case": _case}[part.kind]
    table, drawn = made(part) if part.run and (part.case or part.kind != "case") else (None, [])
    return {
        "name": part.name,
        "shows": part.shows,
        "sentence": part.sentence,
        "command": part.command,
        "links": part.links,
        "table": table,
        "figures": drawn,
        "case": _told(part.case) if part.case else None,
        "frames": [
            (row, moment, f"data:image/png;base64,{base64.b64encode(png).decode()}") for row, moment, png in part.frames
        ],
        "stand_ins": sorted(
            {r.cell.method for r in part.run.rows if r.cell.method.endswith("-rule")} if part.run else ()
        ),
    }


def _rate(cell: CellResults) -> str:
    share, low, high = cell.success
    if share is None or low is None or high is None:
        return "-"
    return f"{100 * share:.0f} ({100 * low:.0f} to {100 * high:.0f})"


def _within(cell: CellResults, low: str, high: str) -> bool | None:
    share = cell.success[0]
    return float(low) <= share <= float(high) if low and high and share is not None else None


def _holds(cell: CellResults, rate: str) -> bool | None:
    """Whether a rate of the paper is within our interval."""
    _, low, high = cell.success
    return low <= float(rate) <= high if rate and low is not None and high is not None else None


def _word(row: ReportedRow) -> str:
    """The variant where the method is the reference, else both."""
    name = row.results.name
    return name.removeprefix("codriving ") if row.cell.method == "codriving" else name


def _ablation(part: PaperPart) -> tuple[ShownTable, list[tuple[str, str]]]:
    assert part.run
    rows = part.run.rows
    scenarios = list(dict.fromkeys(row.cell.scenario for row in rows))
    words = list(dict.fromkeys(map(_word, rows)))
    said = {(row["scenario"], row["variant"]): row for row in part.numbers}
    found = {(row.cell.scenario, _word(row)): row.results for row in rows}

    def cell(scenario: str, word: str) -> AgainstPaper:
        results, theirs = found.get((scenario, word)), said.get((scenario, word.partition("/")[0]), {})
        if results is None:
            return AgainstPaper("")
        low, high = theirs.get("success_low", ""), theirs.get("success_high", "")
        agrees = _holds(results, low) if low and low == high else _within(results, low, high)
        return AgainstPaper(_rate(results), theirs.get("statement", ""), agrees)

    table = ShownTable("row", scenarios, [(word, [cell(s, word) for s in scenarios]) for word in words])
    bars = [(s, [(w, found[s, w]) for w in words if (s, w) in found]) for s in scenarios]
    bounds = {
        (s, w): (float(said[key]["success_low"]), float(said[key]["success_high"]))
        for s in scenarios
        for w in words
        if (key := (s, w.partition("/")[0])) in said and said[key]["success_low"]
    }
    return table, [("Success of each row in each scenario", success_bars(bars, bounds))]


def lesson(row: ReportedRow) -> tuple[int, str]:
    """Give after how many interactions a row was tested, and as which control; empty for none."""
    settings = {key: json.loads(text) for key, text in row.cell.settings.items() if key.startswith("memory.")}
    control = settings.get("memory.control", "none")
    return int(settings.get("memory.interactions", 0)), "" if control == "none" else str(control)


def _learning(part: PaperPart) -> tuple[ShownTable, list[tuple[str, str]]]:
    assert part.run
    found: dict[tuple[str, str], dict[int, CellResults]] = {}
    for row in part.run.rows:
        size, control = lesson(row)
        name = row.cell.scenario, f"control: {control}" if control else ""
        found.setdefault(name, {})[size] = row.results
    sizes = sorted({size for cells in found.values() for size in cells})
    said = {(row["scenario"], row["interactions"]): row for row in part.numbers}

    def cell(scenario: str, control: str, size: int) -> AgainstPaper:
        results, theirs = found[scenario, control].get(size), {} if control else said.get((scenario, str(size)), {})
        if results is None:
            return AgainstPaper("")
        return AgainstPaper(_rate(results), theirs.get("statement", ""), _holds(results, theirs.get("success", "")))

    rows = []
    for scenario, control in found:
        at_first = {} if control else said.get((scenario, ""), {})
        cells = [cell(scenario, control, size) for size in sizes]
        if at_first and cells:
            cells[0] = AgainstPaper(cells[0].ours, at_first["statement"], None)
        rows.append((", ".join(filter(None, (scenario, control))), cells))
    table = ShownTable("past interactions", [str(size) for size in sizes], rows)
    points = {
        row["scenario"]: (int(row["interactions"]), float(row["success"])) for row in part.numbers if row["success"]
    }
    lines = [(scenario, cells) for (scenario, control), cells in found.items() if not control]
    return table, [("Success after so many interactions", learning_lines(lines, points))]


COMPARED = (
    ("success [%]", "success_rate"),
    ("PET mean [s]", "pet_mean"),
    ("max", "pet_max"),
    ("min", "pet_min"),
    ("velocity mean [m/s]", "velocity_mean"),
    ("max ", "velocity_max"),
    ("min ", "velocity_min"),
)


def _comparison(part: PaperPart) -> tuple[ShownTable, list[tuple[str, str]]]:
    assert part.run
    said = {row["method"]: row for row in part.numbers}
    columns = [(head, key) for head, key in COMPARED if any(row.get(key) for row in part.numbers)]
    rows = []
    for row in part.run.rows:
        results = row.results
        theirs = said.get(row.cell.choices.get("method", row.cell.method), {})
        if row.cell.variant not in ("", "full"):
            theirs = {}
        ours = {
            "success_rate": _rate(results),
            **_three("pet", [pet for episode in results.successes for pet in episode.pets]),
            **_three("velocity", [v for episode in results.successes for v in episode.velocities]),
        }
        cells = []
        for _, key in columns:
            text = theirs.get(key, "")
            if key == "success_rate":
                cells.append(
                    AgainstPaper(ours[key], f"{100 * float(text):.0f} %" if text else "", _holds(results, text))
                )
            else:
                cells.append(AgainstPaper(ours[key], text))
        rows.append((f"{theirs.get('label', '')} ({results.name})" if theirs else results.name, cells))
    table = ShownTable("method", [head for head, _ in columns], rows)
    return table, figures([(row.results.name, row.results) for row in part.run.rows])


def _three(name: str, values: Sequence[float]) -> dict[str, str]:
    """Mean, largest and least of what was measured in successful episodes."""
    if not values:
        return {f"{name}_{kind}": "-" for kind in ("mean", "max", "min")}
    return {
        f"{name}_mean": f"{sum(values) / len(values):.1f}",
        f"{name}_max": f"{max(values):.1f}",
        f"{name}_min": f"{min(values):.1f}",
    }


def find_case(good: ReportedRow, bad: ReportedRow, names: tuple[str, str]) -> Case:
    """Choose a start: the first that ends well in one row and not in the other, else the first in which they part."""
    seeds = sorted(good.seeds.keys() & bad.seeds.keys())
    endings = {s: tuple(row.seeds[s].record.outcome.ending.value for row in (good, bad)) for s in seeds}
    differing = [s for s in seeds if endings[s][0] != endings[s][1]]
    rescued = [s for s in differing if endings[s][0] == "success"]
    found = (rescued or differing or [s for s in seeds if _parted(good, bad, s)] or seeds)[0]
    parted = _parted(good, bad, found)
    change = ", ".join(f"{cav}: {mine} and {theirs}" for cav, mine, theirs in parted.changes) if parted else ""
    return Case(found, len(differing), len(seeds), good, bad, names, parted.time if parted else None, change)


def _parted(good: ReportedRow, bad: ReportedRow, seed: int) -> Any:  # noqa: ANN401 - a parting or None
    return parting(*(choices_in(read_decisions(row.seeds[seed].folder)) for row in (good, bad)))


def _case(part: PaperPart) -> tuple[ShownTable, list[tuple[str, str]]]:
    assert part.case
    said = {row["row"]: row for row in part.numbers}
    rows = []
    for name, row in zip(part.case.names, (part.case.good, part.case.bad), strict=True):
        record = row.seeds[part.case.seed].record
        pets = next(e.pets for e in row.results.episodes if e.record.seed == part.case.seed)
        theirs = said.get(name, {})
        ending = record.outcome.ending.value
        cells = [
            AgainstPaper(ending, theirs.get("ending", ""), ending == theirs["ending"] if theirs else None),
            AgainstPaper(f"{record.outcome.time:.1f}"),
            AgainstPaper(f"{min(pets):.1f}" if pets else "-"),
            AgainstPaper(_rate(row.results)),
            AgainstPaper("", theirs.get("statement", "")),
        ]
        rows.append((name, cells))
    heads = ("ends in", "after [s]", "least PET [s]", "success of all starts [%]", "the paper's case")
    return ShownTable("this start", heads, rows), []


def _told(case: Case) -> dict[str, Any]:
    return {
        "seed": case.seed,
        "differing": case.differing,
        "starts": case.starts,
        "time": case.time,
        "change": case.change,
    }


def replay_link(case: Case) -> str:
    """Give the place of a case in the report of its run."""
    moment = f"&t={case.time:.1f}" if case.time is not None else ""
    return f"#ep={case.bad.key(case.seed)}{moment}&with={case.good.key(case.seed)}"
