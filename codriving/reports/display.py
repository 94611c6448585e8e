"""The summary as people read it: rounded, in percent, the paper's row beside ours; console and Markdown share it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from codriving.reports.episodes_table import MEMORY
from codriving.reports.model_display import model_heads, model_notes, model_texts
from codriving.reports.paper import WHOLE, Paper, PaperRow
from codriving.reports.rows import Row, Value
from codriving.reports.stand_in import stand_in_notes
from codriving.reports.wording import episodes_text, interval_text, metrics_text, percent, reasoner_text, three

NOTES = (
    "Rates are over completed episodes, intervals are Wilson 95 %; PET and velocity are over successful episodes.",
)


CLAIM = "the paper says"
"""Head of the column of the paper's statements on an ablation."""


@dataclass(frozen=True, slots=True)
class Line:
    """One printed row."""

    cells: tuple[str, ...]
    ours: bool = True
    last: bool = False


@dataclass(frozen=True, slots=True)
class Display:
    """A table that only has to be drawn."""

    title: str
    columns: tuple[str, ...]
    words: tuple[str, ...]
    lines: tuple[Line, ...]
    notes: tuple[str, ...] = NOTES


def display(
    rows: Sequence[Row],
    paper: Paper,
    metrics: str = "standard",
    swept: Sequence[str] = (),
    notes: Sequence[str] = (),
    seconds: Sequence[float | None] = (),
) -> Display:
    """Prepare the summary for people.

    Args:
        seconds: Wall-clock time of a decision step in each row [s], shown where a language model reasons; nothing for
            what has to repeat to the byte.
    """
    scenarios = list(dict.fromkeys(str(row["scenario"]) for row in rows))
    many = len(scenarios) > 1
    claims = [paper.statement(str(row["scenario"]), str(row["variant"])) for row in rows]
    # Where nothing has been removed there is nothing to compare the claim with.
    ablation = any(claim and row["variant"] not in WHOLE for row, claim in zip(rows, claims, strict=True))
    columns = (
        *(["scenario"] if many else []),
        "method",
        *swept,
        "episodes",
        "success",
        "95 % interval",
        "collision",
        "timeout",
        *(["off road"] if _any(rows, "off_road_rate") else []),
        *(["error"] if _any(rows, "error_rate") else []),
        "PET mean / max / min [s]",
        "PET < 1.5 s",
        "velocity mean / max / min [m/s]",
        *([MEMORY] if _any(rows, MEMORY) else []),
        *model_heads(rows, bool(seconds)),
        *([CLAIM] if ablation else []),
    )
    named = (key for key in swept if not all(_is_number(row.get(key)) for row in rows))
    words = ("scenario", "method", MEMORY, CLAIM, *named)
    theirs = _beside(rows, paper)
    lines: list[Line] = []
    for index, (row, claim) in enumerate(zip(rows, claims, strict=True)):
        model = model_texts(row, seconds[index] if seconds else None)
        lines.append(_line(columns, {**_ours(row, claim), **model, **{key: str(row.get(key, "")) for key in swept}}))
        if index in theirs:
            lines.append(_line(columns, _theirs(row, theirs[index]), ours=False))
        if index + 1 < len(rows) and rows[index + 1]["scenario"] != row["scenario"]:
            lines[-1] = replace(lines[-1], last=True)
    told = (*NOTES, *stand_in_notes(rows), *model_notes(rows, bool(seconds)), *notes)
    return Display(_title(scenarios, rows, metrics), columns, words, tuple(lines), told)


def _line(columns: Sequence[str], texts: Mapping[str, str], ours: bool = True) -> Line:
    return Line(tuple(texts.get(column, "") for column in columns), ours)


def _beside(rows: Sequence[Row], paper: Paper) -> dict[int, PaperRow]:
    """Find the paper's rows, each below the last of ours that it belongs to, so that a sweep quotes it once."""
    last: dict[tuple[str, str], tuple[int, PaperRow]] = {}
    for index, row in enumerate(rows):
        found = paper.row(str(row["scenario"]), str(row["method"]), str(row["variant"]))
        if found is not None:
            last[found.scenario, found.method] = index, found
    return dict(last.values())


def _title(scenarios: Iterable[str], rows: Sequence[Row], metrics: str) -> str:
    reasoners = ", ".join(dict.fromkeys(reasoner_text(str(row["reasoner"])) for row in rows))
    return f"{', '.join(scenarios)} - reasoner: {reasoners}{metrics_text(metrics)}"


def _ours(row: Row, claim: str) -> dict[str, str]:
    variant = str(row["variant"])
    return {
        "scenario": str(row["scenario"]),
        "method": f"{row['method']} {variant}".strip(),
        "episodes": episodes_text(row),
        "success": percent(row["success_rate"]),
        "95 % interval": interval_text(row),
        "collision": percent(row["collision_rate"]),
        "timeout": percent(row["timeout_rate"]),
        "off road": percent(row["off_road_rate"]),
        "error": percent(row["error_rate"]),
        "PET mean / max / min [s]": three(row, "pet"),
        "PET < 1.5 s": percent(row["pet_below_1_5"]),
        "velocity mean / max / min [m/s]": three(row, "velocity"),
        MEMORY: str(row.get(MEMORY) or "off"),
        CLAIM: claim,
    }


def _theirs(row: Row, paper: PaperRow) -> dict[str, str]:
    numbers: Row = paper.numbers
    return {
        "scenario": str(row["scenario"]),
        "method": f"paper: {paper.label}",
        "episodes": paper.episodes_text,
        "success": percent(numbers.get("success_rate")),
        "PET mean / max / min [s]": three(numbers, "pet"),
        "velocity mean / max / min [m/s]": three(numbers, "velocity"),
    }


def _any(rows: Sequence[Row], column: str) -> bool:
    return any(row.get(column) for row in rows)


def _is_number(value: Value) -> bool:
    try:
        float(str(value))
    except ValueError:
        return False
    return True
