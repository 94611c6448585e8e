"""The learning table as people read it."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from codriving.reports.display import NOTES, Display, Line
from codriving.reports.rows import Row
from codriving.reports.wording import episodes_text, fixed, interval_text, metrics_text, percent, reasoner_text, signed

CLAIM = "the paper says"


def learning_display(rows: Sequence[Row], metrics: str, swept: Sequence[str] = ()) -> Display:
    """Prepare the table.

    Args:
        rows: Rows of ``learn.csv``, at least one.
    """
    columns = (
        "scenario", "method", *swept, "interactions", "episodes", "success", "95 % interval", "gain [points] (p)",
        "collision", "timeout", "PET mean [s]", "PET < 1.5 s", "velocity [m/s]", "recalled", "reconsidered", CLAIM,
    )  # fmt: skip
    lines = [Line(tuple(_texts(row, swept).get(column, "") for column in columns)) for row in rows]
    for index, (one, following) in enumerate(pairwise(rows)):
        if any(one.get(key) != following.get(key) for key in ("scenario", "variant", *swept)):
            lines[index] = replace(lines[index], last=True)
    scenarios = ", ".join(dict.fromkeys(str(row["scenario"]) for row in rows))
    reasoners = ", ".join(dict.fromkeys(reasoner_text(str(row["reasoner"])) for row in rows))
    notes = (
        *NOTES,
        "Gains are against the fewest interactions on the same seeds, with the exact McNemar test; recalled counts "
        "memories, reconsidered the decisions that they changed.",
        "Memories are of other seeds than the tests and do not change while these are driven.",
        *_verdict(rows, swept),
    )
    title = f"learning - {scenarios} - reasoner: {reasoners}{metrics_text(metrics)}"
    return Display(title, columns, ("scenario", "method", *swept, CLAIM), tuple(lines), notes)


def _texts(row: Row, swept: Sequence[str]) -> dict[str, str]:
    gain, p = row.get("success_gain"), row.get("mcnemar_p")
    return {
        "scenario": str(row["scenario"]),
        "method": f"{row['method']} {row['variant']}".strip(),
        **{key: str(row.get(key, "")) for key in swept},
        "interactions": str(row["interactions"]),
        "episodes": episodes_text(row),
        "success": percent(row["success_rate"]),
        "95 % interval": interval_text(row),
        "gain [points] (p)": f"{signed(100 * gain, 1)} ({fixed(p, 3)})" if isinstance(gain, float) else "",
        "collision": percent(row["collision_rate"]),
        "timeout": percent(row["timeout_rate"]),
        "PET mean [s]": fixed(row["pet_mean"]),
        "PET < 1.5 s": percent(row["pet_below_1_5"]),
        "velocity [m/s]": fixed(row["velocity_mean"], 2),
        "recalled": str(row.get("recalled") or 0),
        "reconsidered": str(row.get("reconsidered") or 0),
        CLAIM: str(row.get("paper") or ""),
    }


def _verdict(rows: Sequence[Row], swept: Sequence[str]) -> list[str]:
    """Say where the most interactions are shown to differ from the fewest, and that nothing is shown elsewhere."""
    last: dict[tuple[str, ...], Row] = {}
    for row in rows:
        last[tuple(str(row.get(key)) for key in ("scenario", "variant", *swept))] = row
    shown = []
    for row in last.values():
        gain, p = row.get("success_gain"), row.get("mcnemar_p")
        if isinstance(gain, float) and isinstance(p, float) and p < 0.05:
            how = "raise" if gain > 0 else "lower"
            shown.append(f"{row['interactions']} interactions {how} success in {row['scenario']} ({row['variant']})")
    if not shown:
        return [
            "In no setting is a difference in success between the most and the fewest interactions shown (p < 0.05)."
        ]
    return [f"Shown (p < 0.05): {'; '.join(shown)}. Elsewhere no difference in success is shown."]
