"""What a comparison measured as people read it, the paper's row below each of ours."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from codriving.reports.comparison import DRIVEN, METHOD_CHOICE, MISSING, QUOTED_ALONE, Compared
from codriving.reports.display import NOTES, Display, Line
from codriving.reports.model_columns import FALLBACK_RATE
from codriving.reports.model_display import FALLBACK_NOTE, FALLBACKS
from codriving.reports.paper import Paper
from codriving.reports.rows import Row
from codriving.reports.stand_in import stand_in_notes
from codriving.reports.wording import (
    episodes_text,
    fixed,
    interval_text,
    metrics_text,
    percent,
    reasoner_text,
    three,
)

CPU = "CPU [ms]"
"""Head of the column of computing time; on the screen alone, since it differs from machine to machine."""

_MEASURED = (
    "reasoner",
    "episodes",
    "success",
    "95 % interval",
    "PET mean / max / min [s]",
    "PET < 1.5 s",
    "velocity mean / max / min [m/s]",
)
WORDS = ("scenario", "method", "reasoner")
"""Columns of words."""

ALGORITHM = "Reasoner none: an algorithm that has no reasoner. Rules are never a language model."
CPU_NOTE = "CPU: computing time of one decision for all CAVs, of this machine; it stands here and in timing.csv alone."


def measured_display(
    rows: Sequence[Compared], paper: Paper, metrics: str, swept: Sequence[str] = (), cpu: bool = False
) -> Display:
    """Prepare the table of what was measured."""
    asked = [FALLBACKS] if any(FALLBACK_RATE in compared.row for compared in rows) else []
    columns = (*labels(rows, swept), *_MEASURED, *asked, *([CPU] if cpu else []))
    lines: list[Line] = []
    for index, compared in enumerate(rows):
        row = compared.row
        lines.append(line(columns, {**label_texts(row, swept), **_measured(compared)}))
        found = paper.row(str(row["scenario"]), str(row["method"]), str(row.get("variant", "")))
        if found is not None:
            theirs = {
                "scenario": found.scenario,
                "method": f"paper: {found.label}",
                "episodes": found.episodes_text,
                "success": percent(found.numbers.get("success_rate")),
                "PET mean / max / min [s]": three(found.numbers, "pet"),
                "velocity mean / max / min [m/s]": three(found.numbers, "velocity"),
            }
            lines.append(line(columns, theirs, ours=False))
        lines[-1] = replace(lines[-1], last=ends_block(rows, index, swept))
    notes = (*NOTES, *further_notes([compared.row for compared in rows], cpu))
    return Display(_title(rows, metrics), columns, (*WORDS, *swept), tuple(lines), notes)


def further_notes(rows: Sequence[Row], cpu: bool) -> list[str]:
    """Say what a reader has to know of reasoners, missing methods and computing times.

    Args:
        rows: Rows with the columns ``method``, ``reasoner`` and ``status``.
    """
    missing = dict.fromkeys(str(row["method"]) for row in rows if row["status"] == MISSING)
    return [
        *([FALLBACK_NOTE] if any(FALLBACK_RATE in row for row in rows) else []),
        *([ALGORITHM] if any(row.get("reasoner") == "none" for row in rows) else []),
        *([f"{MISSING.capitalize()}: {', '.join(missing)}; to come in a later release."] if missing else []),
        *_stand_in_notes(rows),
        *([CPU_NOTE] if cpu else []),
    ]


def _stand_in_notes(rows: Sequence[Row]) -> list[str]:
    """Say where built-in rules stand in for a language model, which the paper's numbers are not about."""
    notes = stand_in_notes(rows)
    alone = dict.fromkeys(str(row["method"]) for row in rows if row["status"] == QUOTED_ALONE)
    if alone:
        told = "the paper's go by a language model, the rows above by rules."
        notes.append(f"{QUOTED_ALONE.capitalize()}: {', '.join(alone)}; {told}")
    return notes


def _measured(compared: Compared) -> dict[str, str]:
    row = compared.row
    if row["status"] != DRIVEN:
        return {"reasoner": str(row["status"])}
    return {
        "reasoner": reasoner_text(str(row["reasoner"])),
        "episodes": episodes_text(row),
        "success": percent(row["success_rate"]),
        "95 % interval": interval_text(row),
        "PET mean / max / min [s]": three(row, "pet"),
        "PET < 1.5 s": percent(row["pet_below_1_5"]),
        "velocity mean / max / min [m/s]": three(row, "velocity"),
        FALLBACKS: percent(row.get(FALLBACK_RATE)),
        CPU: fixed(compared.cpu * 1000) if compared.cpu is not None else "-",
    }


def labels(rows: Sequence[Compared], swept: Sequence[str]) -> tuple[str, ...]:
    """Give the columns that tell rows apart; one of scenarios only where there are several."""
    many = len({compared.row["scenario"] for compared in rows}) > 1
    return (*(["scenario"] if many else []), "method", *swept)


def label_texts(row: Row, swept: Sequence[str]) -> dict[str, str]:
    """Give the texts of these columns."""
    name = f"{row['method']} {row.get('variant', '')}".strip()
    return {"scenario": str(row["scenario"]), "method": name, **{key: str(row.get(key, "")) for key in swept}}


def line(columns: Sequence[str], texts: Mapping[str, str], ours: bool = True) -> Line:
    """Put texts under their columns."""
    return Line(tuple(texts.get(column, "") for column in columns), ours)


def ends_block(rows: Sequence[Compared], index: int, swept: Sequence[str]) -> bool:
    """Tell whether the next row belongs to other cells than this one."""

    def place(row: Row) -> tuple[object, ...]:
        return (row["scenario"], *(row.get(key) for key in swept if key != METHOD_CHOICE))

    return index + 1 < len(rows) and place(rows[index].row) != place(rows[index + 1].row)


def scenarios(rows: Sequence[Compared]) -> str:
    """Name all scenarios."""
    return ", ".join(dict.fromkeys(str(compared.row["scenario"]) for compared in rows))


def _title(rows: Sequence[Compared], metrics: str) -> str:
    names = dict.fromkeys(reasoner_text(str(c.row["reasoner"])) for c in rows if c.row["status"] == DRIVEN)
    return f"comparison of methods - {scenarios(rows)} - reasoner: {', '.join(names)}{metrics_text(metrics)}"
