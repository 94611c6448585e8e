"""Each method against codriving on the same seeds as people read it, and where one is better, in words."""

from collections.abc import Sequence
from dataclasses import replace

from codriving.metrics.paired import FEWEST, RESAMPLES
from codriving.reports.comparison import REFERENCE, Compared
from codriving.reports.comparison_display import WORDS, ends_block, label_texts, labels, line, scenarios
from codriving.reports.display import Display, Line
from codriving.reports.pairs import better_in, worse_in
from codriving.reports.rows import Row
from codriving.reports.wording import metrics_text, signed

AGAINST = "against codriving"

_PAIRED = (
    "pairs",
    "success [points]",
    "alone: it / codriving",
    "McNemar p",
    "velocity [m/s] (95 %)",
    "PET [s] (95 %)",
    AGAINST,
)
_NOTES = (
    "Each difference is the method minus codriving on the same seeds. Success: exact McNemar test, two-sided.",
    "Velocity and PET: means of an episode, over seeds on which both succeed; 95 % bootstrap intervals of "
    f"{RESAMPLES} resamples, where there are {FEWEST} pairs or more.",
    "Better or worse: p below 0.05, or an interval without 0; each by itself, not corrected for their number.",
)


def paired_display(rows: Sequence[Compared], metrics: str, swept: Sequence[str] = ()) -> Display | None:
    """Prepare the table of differences to codriving on the same seeds.

    Returns:
        The table, with a note on every method that is better than codriving in something; None where there is no
        other method.
    """
    columns = (*labels(rows, swept), *_PAIRED)
    lines: list[Line] = []
    notes: list[str] = []
    for index, compared in enumerate(rows):
        row = compared.row
        if row.get("pairs") is not None:
            lines.append(line(columns, {**label_texts(row, swept), **_differences(row)}))
            if better_in(row):
                notes.append(_better_note(row, swept))
        if lines and ends_block(rows, index, swept):
            lines[-1] = replace(lines[-1], last=True)
    if not lines:
        return None
    if not notes:
        notes = ["No method is shown to be better than codriving in success, velocity or PET on these seeds."]
    title = f"against {REFERENCE} on the same seeds - {scenarios(rows)}{metrics_text(metrics)}"
    return Display(title, columns, (*WORDS, *swept, AGAINST), tuple(lines), (*notes, *_NOTES))


def _differences(row: Row) -> dict[str, str]:
    success, p = row["success_difference"], row["mcnemar_p"]
    return {
        "pairs": str(row["pairs"]),
        "success [points]": signed(100 * success, 1) if isinstance(success, float) else "-",
        "alone: it / codriving": f"{row['only_method_succeeds']} / {row['only_codriving_succeeds']}",
        "McNemar p": f"{p:.2g}" if isinstance(p, float) else "-",
        "velocity [m/s] (95 %)": _with_interval(row, "velocity"),
        "PET [s] (95 %)": _with_interval(row, "pet"),
        AGAINST: _verdict(row),
    }


def _with_interval(row: Row, what: str) -> str:
    low, high = row[f"{what}_difference_low"], row[f"{what}_difference_high"]
    middle = signed(row[f"{what}_difference"]) or "-"
    return middle if low is None else f"{middle} ({signed(low)} to {signed(high)})"


def _verdict(row: Row) -> str:
    better, worse = better_in(row), worse_in(row)
    said = [f"{word} in {', '.join(what)}" for word, what in (("better", better), ("worse", worse)) if what]
    pairs = row["velocity_pairs"]
    few = isinstance(pairs, int) and pairs < FEWEST
    return "; ".join(said) or (f"fewer than {FEWEST} pairs" if few else "no difference shown")


def _better_note(row: Row, swept: Sequence[str]) -> str:
    texts = _differences(row)
    shown = {
        "success": f"success by {texts['success [points]']} points (p = {texts['McNemar p']})",
        "velocity": f"velocity by {texts['velocity [m/s] (95 %)']} m/s",
        "PET": f"PET by {texts['PET [s] (95 %)']} s",
    }
    where = ", ".join([str(row["scenario"]), *(f"{key}={row[key]}" for key in swept if row.get(key))])
    name = label_texts(row, ())["method"]
    return f"Better than codriving: {name} in {' and in '.join(shown[what] for what in better_in(row))} - {where}."
