"""``summary.*``: one row a cell, with Wilson intervals; PET and velocity over successful episodes only."""

import math
import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from codriving.datatypes import Ending
from codriving.reports.columns import Column, Row, Table, Value, mean, share, swept_columns, table
from codriving.reports.decided import DECIDED_NOTE, decisions_by_model, pairs_by_model
from codriving.reports.episodes import counter_columns, episode_columns, number_columns, number_head
from codriving.reports.fitting import METHOD, PAPER
from codriving.reports.judgements import judgement_columns, judgement_notes
from codriving.reports.messages import message_columns
from codriving.reports.paper import WHOLE, Paper, PaperRow
from codriving.reports.printed import PrintedTable, markdown_text, printed
from codriving.reports.results import ASKED, COST, LABELS, SECONDS, CellResults, named_numbers, success_interval
from codriving.reports.wording import interval_text, percent, short_names, stand_in_notes, three, title, two_digits
from codriving.runs import write_text

SEVERE_PET = 1.5  # Below this a PET counts as severe in the paper [s]

NOTE = "Rates are over completed episodes, intervals are Wilson 95 %; PET and velocity are over successful episodes."

CLEAN_NOTE = (
    "Clean: success with every PET at least metrics.near_miss (1.5 s); where no routes cross or merge, every TTC."
)

# Share of the questions that the model gave no usable answer to.
FALLBACK_RATE = "fallback_rate"

FALLBACK_NOTE = (
    "Fallbacks: share of questions without a usable answer; an order is then made by the rules, a decision is the "
    "slowest safe action."
)
STEP = "step [s]"
STEP_NOTE = "Step: time that a decision step waited for the model, on average; step_seconds in the CSV."

CLAIM = "the paper says"  # Head of the column of the paper's statements

CPU = "CPU [ms]"  # Head of the column of computing time; on the screen alone, since it differs from machine to machine

NAME: Column[CellResults] = Column("name", lambda c: c.name, METHOD, words=True, csv=False)

# With the labels, the columns that users rely on, in their fixed order.
MEASURED: tuple[Column[CellResults], ...] = (
    Column("episodes", lambda c: len(c.records)),
    Column("completed", lambda c: len(c.completed)),
    Column("count", lambda c: _count(len(c.completed), len(c.records)), "episodes", csv=False, rank=6),
    Column("success_rate", lambda c: share(len(c.successes), len(c.completed)), "success", percent),
    Column("success_low", lambda c: c.interval[0]),
    Column("success_high", lambda c: c.interval[1]),
    Column("interval", lambda c: interval_text(c.interval), "95 % interval", csv=False, rank=2),
    # As texts, so that none or 0 % is told from what is not known.
    Column("clean", lambda c: percent(c.clean[0]), "clean", csv=False, sparse=True),
    Column("clean_interval", lambda c: interval_text(c.clean[1:]), "clean 95 %", csv=False, sparse=True, rank=3),
    Column("collision_rate", lambda c: c.rate(Ending.COLLISION), "collision", percent, rank=7),
    Column("timeout_rate", lambda c: c.rate(Ending.TIMEOUT), "timeout", percent, rank=9),
    Column("off_road", lambda c: c.rate(Ending.OFF_ROAD), "off road", percent, csv=False, sparse=True, rank=9),
    Column(
        "error_rate",
        lambda c: share(len(c.records) - len(c.completed), len(c.records)),
        "error",
        percent,
        sparse=True,
        rank=1,
    ),
    Column("pet_mean", lambda c: mean(c.pets)),
    Column("pet_max", lambda c: max(c.pets, default=None)),
    Column("pet_min", lambda c: min(c.pets, default=None)),
    Column("pet", lambda c: _three(c.pets), "PET mean / max / min [s]", csv=False, rank=4, brief=("PET [s]", " / ")),
    Column(
        "pet_below_1_5",
        lambda c: share(sum(p < SEVERE_PET for p in c.pets), len(c.pets)),
        "PET < 1.5 s",
        percent,
        rank=8,
    ),
    Column("velocity_mean", lambda c: mean(c.velocities)),
    Column("velocity_max", lambda c: max(c.velocities, default=None)),
    Column("velocity_min", lambda c: min(c.velocities, default=None)),
    Column(
        "velocity",
        lambda c: _three(c.velocities),
        "velocity mean / max / min [m/s]",
        csv=False,
        rank=3,
        brief=("velocity [m/s]", " / "),
    ),
)

CLEAN: tuple[Column[CellResults], ...] = (
    Column("clean_rate", lambda c: c.clean[0]),
    Column("clean_low", lambda c: c.clean[1]),
    Column("clean_high", lambda c: c.clean[2]),
)

FURTHER: tuple[Column[CellResults], ...] = (
    Column("off_road_rate", lambda c: c.rate(Ending.OFF_ROAD)),
    Column("success_planned", lambda c: share(len(c.successes), len(c.records))),
    Column("success_planned_low", lambda c: success_interval(len(c.successes), len(c.records))[0]),
    Column("success_planned_high", lambda c: success_interval(len(c.successes), len(c.records))[1]),
    Column("pet_median", lambda c: statistics.median(c.pets) if c.pets else None),
    Column("pet_count", lambda c: len(c.pets)),
    Column("travel_time_mean", lambda c: mean([time for e in c.successes for time in e.times])),
    Column("delay_mean", lambda c: mean([delay for e in c.successes for delay in e.delays])),
    Column("duration_mean", lambda c: mean([e.record.outcome.time for e in c.successes])),
    Column("collision_cav_cav", lambda c: c.collisions["CAV-CAV"]),
    Column("collision_cav_hdv", lambda c: c.collisions["CAV-HDV"]),
    Column("collision_cav_block", lambda c: c.collisions["CAV-block"]),
    Column("bystander_collisions", lambda c: sum(len(e.record.outcome.bystander_collisions) for e in c.completed)),
    Column("decisions", lambda c: sum(record.decisions for record in c.records)),
    *CLEAN,
)

MEMORY: Column[CellResults] = Column(
    "memory",
    lambda c: c.first.memory or None,
    "memory",
    lambda value: "off" if value is None else str(value),
    words=True,
    sparse=True,
)

# Where a row is not repeatable: the times of its language model were measured.
REPEATABLE: Column[CellResults] = Column(
    "repeatable", lambda c: "yes" if c.repeatable else "no", "repeatable", words=True
)

MEASURED_NOTE = (
    "Not repeatable: llm.latency=measured with a model that was asked, whose times no second run measures alike; with "
    "llm.cache=replay they are replayed."
)

FALLBACKS: Column[CellResults] = Column(FALLBACK_RATE, lambda c: c.fallback_rate, "fallbacks", percent, rank=5)

# How much a language model decided; as texts on the screen, so that 0 % is told from what was not counted.
BY_MODEL: tuple[Column[CellResults], ...] = (
    Column("decisions_by_model", lambda c: decisions_by_model(c.decided)),
    Column("pairs_by_model", lambda c: pairs_by_model(c.decided)),
)
BY_MODEL_TEXTS: tuple[Column[CellResults], ...] = (
    Column(
        "decided_text", lambda c: percent(decisions_by_model(c.decided)), "decisions by model", csv=False, sparse=True
    ),
    Column("ordered_text", lambda c: percent(pairs_by_model(c.decided)), "pairs by model", csv=False, sparse=True),
)

_LABELS = [column.of(lambda c: c.first) for column in LABELS]

BY_KEY = {column.key: column for column in (*_LABELS, *MEASURED, *FURTHER, MEMORY, FALLBACKS)}

# What a language model was asked, as people read it; nothing where none reasons.
ASKED_COLUMNS: tuple[Column[CellResults], ...] = (
    Column("calls", lambda c: _if_asked(c, _thousands(c.counters.get("model_calls"))), "calls", csv=False, rank=7),
    Column("tokens", lambda c: _if_asked(c, _tokens(c.counters)), "tokens prompt + completion", csv=False, rank=9),
    Column("cost", lambda c: _if_asked(c, _money(c.counters.get(COST))), "cost [USD]", csv=False, rank=6),
    Column("fallbacks_text", lambda c: _if_asked(c, percent(c.fallback_rate) or "-"), "fallbacks", csv=False, rank=5),
    Column("step", lambda c: _if_asked(c, two_digits(c.counters.get(SECONDS)) or "-"), STEP, csv=False, rank=8),
)


def summary_table(cells: Sequence[CellResults], swept: Sequence[str] = ()) -> Table:
    """Make the summary: fixed columns, swept keys, and the counters of methods."""
    records = [record for cell in cells for record in cell.records]
    model = any(cell.asked for cell in cells)
    numeric = {key for key in swept if all(_is_number(cell.swept.get(key)) for cell in cells)}
    values = [replace(column, words=column.key not in numeric) for column in swept_columns(swept)]
    known: list[Column[Any]] = [
        *labels(cells, len({cell.first.scenario for cell in cells}) > 1),
        # The CSV has them after the columns that users rely on.
        *(replace(column, csv=False) for column in values),
        *MEASURED,
        *(replace(column, head="") for column in values),
        *FURTHER,
        *([MEMORY] if any(record.memory for record in records) else []),
        *([] if all(cell.repeatable for cell in cells) else [REPEATABLE]),
        *message_columns(cells),
        *judgement_columns(cells),
    ]
    known += number_columns(named_numbers(cells), known)
    counters = counter_columns(records, known)
    rate = len([column for column in counters if column.key in ASKED]) if model else 0
    shares = [replace(FALLBACKS, head=""), *(BY_MODEL if any(c.decided for c in cells) else ())] if model else []
    rest = [*counters[:rate], *shares, *counters[rate:]]
    return table([*known, *rest, *((*BY_MODEL_TEXTS, *ASKED_COLUMNS) if model else ())], cells)


def labels(cells: Sequence[CellResults], scenario: bool) -> list[Column[Any]]:
    """Give the columns that tell rows apart: the reasoner where nothing else does."""
    named = [(cell.first.scenario, cell.name, *cell.swept.items()) for cell in cells]
    texts = short_names(cell.first.reasoner for cell in cells)
    alike = len(set(named)) < len({(name, cell.first.reasoner) for name, cell in zip(named, cells, strict=True)})
    reasoner: Column[CellResults] = Column(
        "reasoning", lambda c: texts[c.first.reasoner], "reasoner", words=True, csv=False
    )
    return [
        replace(_LABELS[0], head="scenario" if scenario else ""),
        *_LABELS[1:],
        NAME,
        *([reasoner] if alike else []),
    ]


def print_summary(
    cells: Sequence[CellResults],
    paper: Paper,
    metrics: str = "standard",
    swept: Sequence[str] = (),
    notes: Iterable[str] = (),
    screen: bool = False,
) -> PrintedTable:
    """Prepare the summary for people: rounded, in percent, the paper's row beside ours."""
    made = summary_table(cells, swept)
    claims = [paper.statement(cell.first.scenario, cell.first.variant) if cell.papers_setting else "" for cell in cells]
    # Where nothing has been removed there is nothing to compare the claim with.
    ablation = any(claim and cell.first.variant not in WHOLE for cell, claim in zip(cells, claims, strict=True))
    claimed: list[Column[Any]] = [Column("claim", lambda _: None, CLAIM, words=True, rank=1)] if ablation else []
    rows = tuple({**row, "claim": claim} for row, claim in zip(made.rows, claims, strict=True))
    scenarios, reasoners = ([row[key] for row in rows] for key in ("scenario", "reasoner"))
    models = stand_in_notes((row["method"], row["reasoner"]) for row in rows)
    said = (NOTE, *clean_notes(cells), *number_notes(cells), *models, *remarks(cells), *model_notes(cells))
    said = (*said, *decided_notes(cells), *judgement_notes(cells), *notes)
    heading, shown = title("", scenarios, reasoners, metrics), Table((*made.columns, *claimed), rows)
    blocks = [(scenario, cell.is_control) for scenario, cell in zip(scenarios, cells, strict=True)]
    return printed(heading, shown, blocks, said, _beside(cells, paper), screen)


def clean_notes(cells: Iterable[CellResults]) -> list[str]:
    """Say what a clean success is, where it is shown."""
    return [CLEAN_NOTE] if any(cell.judged for cell in cells) else []


def remarks(cells: Iterable[CellResults]) -> list[str]:
    """Say what has to be known of methods, and of rows that are not repeatable, once each."""
    said = (text for cell in cells for text in (cell.remark, "" if cell.repeatable else MEASURED_NOTE))
    return list(dict.fromkeys(text for text in said if text))


def number_notes(cells: Iterable[CellResults]) -> list[str]:
    """Say what the further numbers of metrics are that are shown, and what is better."""
    return [
        f"{number_head(number)}: mean over completed episodes"
        + (f"; {number.better} is better." if number.better else ".")
        for number in named_numbers(cells)
        if number.shown
    ]


def paper_row(paper: PaperRow) -> Row:
    """Give the paper's numbers as a row to stand below ours."""
    numbers = paper.numbers
    return {
        "scenario": paper.scenario,
        "name": f"{PAPER}{paper.label}",
        "count": "-" if paper.episodes is None else str(paper.episodes),
        "success_rate": numbers.get("success_rate"),
        "memory": "",
        "pet": _quoted(numbers, "pet"),
        "velocity": _quoted(numbers, "velocity"),
    }


def _quoted(numbers: Mapping[str, float], what: str) -> str:
    """Three numbers of the paper; nothing where it gives none."""
    given = [numbers.get(f"{what}_{which}") for which in ("mean", "max", "min")]
    return three(*given) if any(number is not None for number in given) else ""


def _beside(cells: Sequence[CellResults], paper: Paper) -> dict[int, Row]:
    """Find the paper's rows, each below the last of ours that it belongs to, so that a sweep quotes it once."""
    last: dict[tuple[str, str], tuple[int, PaperRow]] = {}
    for index, cell in enumerate(cells):
        found = paper.row(cell.first.scenario, cell.first.method, cell.first.variant)
        if found is not None and cell.as_in_paper:
            last[found.scenario, found.method] = index, found
    return {index: paper_row(row) for index, row in last.values()}


def model_notes(cells: Sequence[CellResults]) -> list[str]:
    """Sum up what the models of all rows were asked."""
    found = [cell.counters for cell in cells if cell.asked]
    if not found:
        return []
    total = {name: sum(int(counters[name] or 0) for counters in found) for name in ASKED if name != COST}
    priced = [float(counters[COST] or 0.0) for counters in found if counters[COST] is not None]
    price = f"{_money(math.fsum(priced))} USD" if priced else "cost not known"
    if priced and len(priced) < len(found):
        price += " and what is not known"
    return [
        f"In all: {total['model_calls']:,} calls, {total['prompt_tokens']:,} + {total['completion_tokens']:,} tokens, "
        f"{price}; {total['re_asks']:,} asked again, {total['mended']:,} mended, {total['fallbacks']:,} fallbacks, "
        f"{total['repaired_orders']:,} repaired orders.",
        f"{FALLBACK_NOTE} Failed episodes count in all sums.",
        STEP_NOTE,
    ]


def decided_notes(cells: Iterable[CellResults]) -> list[str]:
    """Say whose decisions were, and of which rows too few were the model's."""
    known = [cell for cell in cells if cell.decided]
    told = [cell.decided.warning(_row_name(cell)) for cell in known if cell.decided]
    return [DECIDED_NOTE, *dict.fromkeys(text for text in told if text)] if known else []


def _row_name(cell: CellResults) -> str:
    """Name a row by what tells it from others: scenario, method, model, and what was swept."""
    first = cell.first
    words = [f"{key}={value}" for key, value in cell.swept.items()]
    return " ".join([first.reasoner, f"({', '.join([first.scenario, cell.name, *words])})"])


def _count(completed: int, episodes: int) -> str:
    """How many episodes there are, and how many of them were driven to an end where some were not."""
    return str(episodes) if completed == episodes else f"{completed}/{episodes}"


def _three(values: Sequence[float]) -> str:
    return three(mean(values), max(values, default=None), min(values, default=None))


def _if_asked(cell: CellResults, text: str) -> str:
    return text if cell.asked else ""


def _tokens(counters: dict[str, Value]) -> str:
    return f"{_thousands(counters.get('prompt_tokens'))} + {_thousands(counters.get('completion_tokens'))}"


def _thousands(value: Value) -> str:
    return f"{value:,}" if isinstance(value, int | float) else "-"


def _money(value: Value) -> str:
    return f"{value:.4f}" if isinstance(value, int | float) else "-"


def _is_number(value: object) -> bool:
    try:
        float(str(value))
    except ValueError:
        return False
    return True


@dataclass(frozen=True, slots=True)
class RunTables:
    """The tables of one run."""

    episodes: Table
    summary: Table
    page: PrintedTable  # The summary as people read it, of ``summary.md``
    printed: PrintedTable  # The same for the screen, with times

    def write(self, folder: Path) -> None:
        """Write ``episodes.csv``, ``summary.csv`` and ``summary.md``.

        Raises:
            OSError: If the folder cannot be written.
        """
        write_text(folder / "episodes.csv", self.episodes.csv())
        write_text(folder / "summary.csv", self.summary.csv())
        write_text(folder / "summary.md", markdown_text(self.page))


def run_tables(
    cells: Sequence[CellResults], paper: Paper, metrics: str = "standard", notes: Iterable[str] = ()
) -> RunTables:
    """Make all tables of a run."""
    swept = tuple(dict.fromkeys(key for cell in cells for key in cell.swept))
    notes = tuple(notes)
    return RunTables(
        table(episode_columns(cells, swept), [episode for cell in cells for episode in cell.episodes]),
        summary_table(cells, swept),
        print_summary(cells, paper, metrics, swept, notes),
        print_summary(cells, paper, metrics, swept, notes, screen=True),
    )
