"""The table of loads as people read it: success, velocity and computing time at each number of CAVs."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from codriving.reports.comparison import METHOD_CHOICE, MISSING
from codriving.reports.comparison_display import further_notes
from codriving.reports.display import Display, Line
from codriving.reports.load import Loaded
from codriving.reports.model_columns import FALLBACK_RATE
from codriving.reports.model_display import FALLBACK_NOTE, FALLBACKS
from codriving.reports.rows import Row
from codriving.reports.wording import fixed, metrics_text, percent, reasoner_text

NOTE = "Rates are over completed episodes, with Wilson 95 % intervals; velocity is the mean over successful episodes."


def load_display(
    rows: Sequence[Loaded], loads: Sequence[int], metrics: str, swept: Sequence[str] = (), cpu: bool = False
) -> Display:
    """Prepare the table of loads."""
    model = any(row.model for row in rows)
    asked = [FALLBACKS] if model else []
    measures = ("success (95 %)", "velocity [m/s]", *asked, *(["CPU [ms]"] if cpu else []))
    heads = [f"{measure}, {cavs} CAVs" for measure in measures for cavs in loads]
    columns = ("scenario", "method", *swept, "reasoner", "episodes", *heads)
    lines = [Line(tuple(_texts(row, loads, swept).get(column, "") for column in columns)) for row in rows]
    keys = ("scenario", *(key for key in swept if key != METHOD_CHOICE))
    for index, (one, following) in enumerate(pairwise(rows)):
        if any(one.labels[key] != following.labels[key] for key in keys):
            lines[index] = replace(lines[index], last=True)
    words = ("scenario", "method", *swept, "reasoner")
    notes = (NOTE, *([FALLBACK_NOTE] if model else []), *further_notes([row.labels for row in rows], cpu))
    return Display(load_title(rows, metrics), columns, words, tuple(lines), notes)


def load_title(rows: Sequence[Loaded], metrics: str) -> str:
    """Say what is shown and who reasoned."""
    scenarios = ", ".join(dict.fromkeys(str(row.labels["scenario"]) for row in rows))
    driven = [row for row in rows if row.labels["status"] != MISSING]
    reasoners = ", ".join(dict.fromkeys(reasoner_text(str(row.labels["reasoner"])) for row in driven))
    return f"load - {scenarios} - reasoner: {reasoners}{metrics_text(metrics)}"


def method_text(labels: Row) -> str:
    """Name the method of a row, with its variant."""
    return f"{labels['method']} {labels.get('variant', '')}".strip()


def _texts(row: Loaded, loads: Sequence[int], swept: Sequence[str]) -> dict[str, str]:
    labels = row.labels
    missing = labels["status"] == MISSING
    texts = {
        "scenario": str(labels["scenario"]),
        "method": method_text(labels),
        "reasoner": MISSING if missing else reasoner_text(str(labels["reasoner"])),
        "episodes": "" if missing else str(row.row()["episodes"]),
        **{key: str(labels.get(key, "")) for key in swept},
    }
    for cavs in loads:
        if cavs in row.at:
            at, cpu = row.at[cavs], row.cpu[cavs]
            texts[f"success (95 %), {cavs} CAVs"] = _success(at)
            texts[f"velocity [m/s], {cavs} CAVs"] = fixed(at["velocity_mean"], 2) or "-"
            texts[f"{FALLBACKS}, {cavs} CAVs"] = percent(at.get(FALLBACK_RATE))
            texts[f"CPU [ms], {cavs} CAVs"] = fixed(cpu * 1000) if cpu is not None else "-"
    return texts


def _success(row: Row) -> str:
    low, high = (percent(row[name]).removesuffix(" %") for name in ("success_low", "success_high"))
    return f"{percent(row['success_rate'])} ({low} to {high})" if low else "-"
