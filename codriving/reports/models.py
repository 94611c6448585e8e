"""``models.*``: one method with each language model, with controls and with the rules in its place."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from codriving.metrics import FEWEST, RESAMPLES
from codriving.reports.columns import Column, Table, Value, share, swept_columns, table
from codriving.reports.decided import (
    AS_RULES_NOTE,
    FALLBACK,
    ONE_OPTION,
    PLAIN,
    REPAIRED,
    Breakdown,
    decisions_by_model,
    pairs_by_model,
)
from codriving.reports.pairs import PairedCells, corrected, p_text, points
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.results import CellResults
from codriving.reports.summary import (
    ASKED_COLUMNS,
    BY_KEY,
    NOTE,
    clean_notes,
    decided_notes,
    model_notes,
    remarks,
)
from codriving.reports.wording import interval_text, percent, reasoner_text, stand_in_notes, title

RULES = "rules"

CONTROLS_NOTE = (
    "Control: no language model; its answers are made from the form of each question and read as a model's are. Its "
    "tokens are estimated, 4 bytes each, and are not summed up with a model's."
)
RULES_NOTE = "rules (llm=offline): the built-in rules and no language model; they are asked nothing."
SAME_NOTE = (
    "Same: of the questions that were asked in the same words at the same time of a later drive of the same seed, "
    "those with the same decision; and of the later drives those with the same ending. All other numbers are of the "
    "first drive."
)


@dataclass(frozen=True, slots=True)
class Repetition:
    """What was the same when the same seeds were driven again."""

    times: int  # How often each seed was driven
    answered: int  # Questions asked again in the same words that had the same decision
    asked: int  # Questions asked again in the same words
    ended: int  # Later episodes with the same ending
    episodes: int  # Later episodes

    @property
    def decisions(self) -> float | None:
        """Share of the same decisions."""
        return share(self.answered, self.asked)

    @property
    def text(self) -> str:
        """The same in words: a share of few questions says little."""
        return f"{percent(self.decisions) or '-'} of {self.asked:,}"

    @property
    def outcomes(self) -> float | None:
        """Share of the same endings."""
        return share(self.ended, self.episodes)


@dataclass(frozen=True)
class ModelRow:
    """One model in one setting."""

    cell: CellResults  # The first time that it drove each seed
    same: Repetition | None = None  # None where it drove each seed once
    pairs: PairedCells | None = None  # Against the reference; None for the reference
    reference: str = ""  # What it is compared with

    @property
    def swept(self) -> dict[str, str]:
        """What it was driven with beside others."""
        return dict(self.cell.swept)

    @property
    def numbers(self) -> dict[str, float | None]:
        """Further numbers of the metric by name."""
        return self.cell.numbers


def model_rows(block: Sequence[tuple[CellResults, Repetition | None]]) -> list[ModelRow]:
    """Compare the models of one setting: with the rules, or with the first where they were not driven.

    Returns:
        The rows, controls below the others; best first by clean success, then by the mean time of all vehicles.
    """
    cells = [cell for cell, _ in block]
    reference = next((cell for cell in cells if cell.first.reasoner == RULES), cells[0])
    name = reasoner_text(reference.first.reasoner)
    found = iter(corrected([PairedCells(cell, reference) for cell in cells if cell is not reference]))
    rows = [ModelRow(c, same, None if c is reference else next(found), name) for c, same in block]
    return sorted(rows, key=lambda row: (row.cell.is_control, *row.cell.standing))


def _share(of: str, what: str) -> Callable[[ModelRow], Value]:
    """Give the share of decisions or pairs that something decided."""

    def value(row: ModelRow) -> Value:
        found: Breakdown | None = getattr(row.cell.decided, of) if row.cell.decided else None
        return found.part(what) if found else None

    return value


def _like_rules(of: str) -> Callable[[ModelRow], Value]:
    """Give the share of a model's decisions or pairs that the rules would have decided the same."""

    def value(row: ModelRow) -> Value:
        found: Breakdown | None = getattr(row.cell.decided, of) if row.cell.decided else None
        return found.like_rules if found else None

    return value


def _dash(value: Value) -> str:
    return percent(value) or "-"


def model_table(rows: Sequence[ModelRow], swept: Sequence[str] = ()) -> Table:
    """Make the table."""
    several = len({row.cell.first.scenario for row in rows}) > 1
    methods = len({row.cell.name for row in rows}) > 1

    def of_cell(key: str, head: str = "", rank: int = 0) -> Column[Any]:
        own = BY_KEY[key].of(lambda row: row.cell)
        return replace(own, head=head, csv=True, sparse=False, rank=rank)

    def of_pairs(key: str, value: Callable[[PairedCells], Value], head: str = "", rank: int = 0) -> Column[Any]:
        return Column(key, lambda row: value(row.pairs) if row.pairs else None, head, rank=rank, csv=not head)

    def counter(name: str) -> Column[Any]:
        return Column(name, lambda row: row.cell.counters.get(name) if row.cell.asked else None)

    columns: list[Column[Any]] = [
        Column("scenario", lambda r: r.cell.first.scenario, "scenario" if several else "", words=True),
        Column("method", lambda r: r.cell.first.method, words=True),
        Column("variant", lambda r: r.cell.first.variant, words=True),
        Column("name", lambda r: r.cell.name, "method" if methods else "", words=True, csv=False),
        Column("reasoner", lambda r: r.cell.first.reasoner, words=True),
        Column("model", lambda r: reasoner_text(r.cell.first.reasoner), "model", words=True, csv=False),
        *swept_columns(swept),
        of_cell("episodes", "episodes", 9),
        of_cell("completed"),
        of_cell("success_rate", "success"),
        of_cell("success_low"),
        of_cell("success_high"),
        Column("clean_text", lambda r: percent(r.cell.clean[0]), "clean", csv=False, sparse=True),
        Column(
            "clean_interval", lambda r: interval_text(r.cell.clean[1:]), "clean 95 %", csv=False, sparse=True, rank=8
        ),
        *(of_cell(key) for key in ("clean_rate", "clean_low", "clean_high")),
        of_cell("collision_rate", "collision", 10),
        of_cell("timeout_rate", "timeout", 10),
        of_cell("pet_below_1_5", "PET < 1.5 s", 10),
        of_cell("velocity_mean"),
        Column("time_all", lambda r: r.numbers.get("time_all")),
        of_pairs("pairs", lambda p: len(p.driven)),
        of_pairs("clean_difference", lambda p: p.clean.difference),
        of_pairs("clean_mcnemar_p_holm", lambda p: p.clean.corrected),
        of_pairs("success_difference", lambda p: p.success.difference),
        of_pairs("mcnemar_p_holm", lambda p: p.success.corrected),
        of_pairs("velocity_difference", lambda p: p.velocity.mean),
        of_pairs("velocity_difference_low", lambda p: p.velocity.low),
        of_pairs("velocity_difference_high", lambda p: p.velocity.high),
        of_pairs("success_points", lambda p: points(p.success.difference), "success [points]", 5),
        of_pairs("clean_points", lambda p: points(p.clean.difference), "clean [points]", 4),
        of_pairs("clean_holm", lambda p: p_text(p.clean.corrected), "clean p (Holm)", 6),
        of_pairs("velocity", lambda p: str(p.velocity), "velocity [m/s] (95 %)", 7),
        Column("decisions_by_model", lambda r: decisions_by_model(r.cell.decided), "decisions by model", _dash),
        Column("decisions_plain", _share("decisions", PLAIN), "plain", _dash, rank=11),
        Column("decisions_one_option", _share("decisions", ONE_OPTION), "one option", _dash, rank=11),
        Column("decisions_mended", _share("decisions", "mended"), "mended", _dash, rank=12),
        Column("decisions_fallback", _share("decisions", FALLBACK), "fallback", _dash, rank=11),
        Column("pairs_by_model", lambda r: pairs_by_model(r.cell.decided), "pairs by model", _dash),
        Column("pairs_repaired", _share("pairs", REPAIRED), "repaired", _dash, rank=11),
        Column("pairs_mended", _share("pairs", "mended"), "mended pairs", _dash, rank=12),
        Column("pairs_fallback", _share("pairs", FALLBACK), "fallback pairs", _dash, rank=12),
        Column("decisions_like_rules", _like_rules("decisions"), "as rules", _dash, rank=1),
        Column("pairs_like_rules", _like_rules("pairs"), "pairs as rules", _dash, rank=5),
        *_same_columns(rows),
        *(counter(name) for name in ("model_calls", "prompt_tokens", "completion_tokens", "cached_tokens")),
        *(counter(name) for name in ("reasoning_tokens", "cost_usd", "step_seconds", "re_asks", "cut_off", "withheld")),
        *(column.of(lambda r: r.cell) for column in ASKED_COLUMNS if column.key != "fallbacks_text"),
    ]
    return table(columns, rows)


def _same_columns(rows: Sequence[ModelRow]) -> list[Column[Any]]:
    if not any(row.same for row in rows):
        return []
    return [
        Column("epochs", lambda r: r.same.times if r.same else 1),
        Column("same_decisions", lambda r: r.same.decisions if r.same else None),
        Column("same_text", lambda r: r.same.text if r.same else "-", "same decisions", rank=2, csv=False),
        Column("same_outcomes", lambda r: r.same.outcomes if r.same else None, "same outcomes", _dash, rank=3),
        Column("asked_again", lambda r: r.same.asked if r.same else None),
    ]


def print_models(
    rows: Sequence[ModelRow],
    everything: Sequence[CellResults],
    metrics: str,
    swept: Sequence[str] = (),
    further: Iterable[str] = (),
    screen: bool = False,
) -> PrintedTable:
    """Prepare the table for people.

    Args:
        everything: All that was driven, also again, of which the sums below the table are.
        further: What else has to be said.
    """
    cells = [row.cell for row in rows]
    against = ", ".join(dict.fromkeys(row.reference for row in rows))
    heading = title("models", [c.first.scenario for c in cells], [c.first.reasoner for c in cells], metrics)
    asked = any(cell.decided for cell in cells)
    notes = [
        NOTE,
        *clean_notes(cells),
        f"Differences are each row minus {against} on the same seeds. Clean: exact McNemar test, two-sided, corrected "
        f"for the number of rows (Holm). Velocity: over seeds on which both succeed, with 95 % bootstrap intervals of "
        f"{RESAMPLES} resamples where there are {FEWEST} pairs or more.",
        *decided_notes(cells),
        *([AS_RULES_NOTE] if asked else []),
        *([SAME_NOTE] if any(row.same for row in rows) else []),
        *([CONTROLS_NOTE] if any(cell.is_control for cell in cells) else []),
        *([RULES_NOTE] if any(cell.first.reasoner == RULES for cell in cells) else []),
        *stand_in_notes((cell.first.method, cell.first.reasoner) for cell in cells),
        *remarks(cells),
        *model_notes([cell for cell in everything if cell.asked and not cell.is_control] or everything),
        *further,
    ]
    blocks = [(row.cell.first.scenario, tuple(row.swept.items()), row.cell.is_control) for row in rows]
    return printed(heading, model_table(rows, swept), blocks, notes, screen=screen)
