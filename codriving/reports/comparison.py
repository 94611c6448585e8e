"""``comparison.*`` and ``load.*``: one row a method and scenario, missing methods included, as both compare them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Any

from codriving.metrics import FEWEST, RESAMPLES
from codriving.reports.columns import Column, Table, Value, swept_columns, table
from codriving.reports.episodes import number_columns
from codriving.reports.pairs import PAIRED, PairedCells, corrected, p_text, points
from codriving.reports.paper import Paper, PaperRow
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.results import CellResults, named_numbers
from codriving.reports.summary import (
    BY_KEY,
    CLEAN,
    CPU,
    FALLBACK_NOTE,
    FALLBACKS,
    MEASURED,
    NOTE,
    clean_notes,
    number_notes,
    paper_row,
    remarks,
)
from codriving.reports.wording import (
    metrics_text,
    milliseconds,
    percent,
    place_of,
    reasoner_text,
    stand_in_notes,
    title,
    two_digits,
)

REFERENCE = "codriving"  # The method that all others are compared with

# Whether a method could be driven; the last for one that goes by a language model, where rules stood in for it.
DRIVEN, MISSING, QUOTED_ALONE = "driven", "not there yet", "only in the paper"

# The swept key that two methods of one name are told apart by; it belongs to a row, all others to a block.
METHOD_CHOICE = "method_choice"

ALGORITHM = "Reasoner none: an algorithm that has no reasoner. Rules are never a language model."
CPU_NOTE = "CPU: computing time of one decision for all CAVs, of this machine; it stands here and in timing.csv alone."

QUOTED = ("success_rate", "pet_mean", "pet_max", "pet_min", "velocity_mean", "velocity_max", "velocity_min")

PAIRED_NOTES = (
    "Each difference is the method minus codriving on the same seeds. Success and clean success: exact McNemar test, "
    "two-sided.",
    "Velocity and PET: means of an episode, over seeds on which both succeed; 95 % bootstrap intervals of "
    f"{RESAMPLES} resamples, where there are {FEWEST} pairs or more.",
    "Better or worse: p (Holm) below 0.05, or an interval without 0. Holm: corrected for the number of rows of the "
    "whole comparison, success and clean success each by itself; intervals are not corrected.",
    "Level: at most 3 points below the other, and not shown to be worse.",
)


@dataclass(frozen=True)
class Compared:
    """One row of the comparison."""

    scenario: str
    method: str
    status: str = DRIVEN
    cell: CellResults | None = None  # What was driven; None for a method that was not
    quoted: PaperRow | None = None  # The paper's row, if it has one
    swept: Mapping[str, str] = field(default_factory=dict)
    pairs: PairedCells | None = None  # The comparison with the reference on the same seeds

    @property
    def name(self) -> str:
        """The method, with its variant."""
        return self.cell.name if self.cell else self.method

    @property
    def block(self) -> tuple[object, ...]:
        """What it shares with all rows of its block."""
        return self.scenario, *setting_of(self.swept).items()


def setting_of(swept: Mapping[str, str]) -> Mapping[str, str]:
    """Give the swept keys that a cell shares with all cells of its block."""
    return {key: value for key, value in swept.items() if key != METHOD_CHOICE}


def _cells(rows: Iterable[Compared]) -> list[CellResults]:
    return [row.cell for row in rows if row.cell]


def status_columns(scenario: bool) -> list[Column[Any]]:
    """Give the columns of labels and status, of what has a cell."""
    return [
        Column("scenario", lambda r: r.scenario, "scenario" if scenario else "", words=True),
        Column("method", lambda r: r.method, words=True),
        *(BY_KEY[key].of(lambda r: r.cell) for key in ("variant", "reasoner")),
        Column("status", lambda r: r.status, words=True),
        Column("name", lambda r: r.name, "method", words=True, csv=False),
    ]


def reasoner_column(rows: Sequence[Any]) -> Column[Any]:
    """Give the column of what reasons; on a narrow terminal it gives way unless it tells rows apart."""
    named = {(row.scenario, row.name, *row.swept.items()) for row in rows if row.status == DRIVEN}
    return Column(
        "reasoning",
        lambda r: reasoner_text(r.cell.first.reasoner) if r.status == DRIVEN else r.status,
        "reasoner",
        words=True,
        csv=False,
        rank=5 if len(named) == sum(row.status == DRIVEN for row in rows) else 0,
        brief=("reasoner", " ("),
    )


def comparison_table(rows: Sequence[Compared], swept: Sequence[str] = ()) -> Table:
    """Make the table of a comparison."""
    rates = ("collision_rate", "timeout_rate", "off_road", "error_rate")
    columns: list[Column[Any]] = [
        *status_columns(len({row.scenario for row in rows}) > 1),
        *swept_columns(swept),
        reasoner_column(rows),
        *(column.of(lambda row: row.cell) for column in (*MEASURED, *CLEAN) if column.key not in rates),
        *(column.of(lambda row: row.cell) for column in number_columns(named_numbers(_cells(rows)), MEASURED)),
        *([FALLBACKS.of(lambda row: row.cell)] if any(row.cell and row.cell.asked for row in rows) else []),
        Column("cpu", lambda r: milliseconds(r.cell.cpu) if r.cell else "", CPU, csv=False, page=False, rank=7),
        *(replace(column, head="").of(lambda r: r.pairs) for column in PAIRED if column.csv),
        *map(_quoted, QUOTED),
    ]
    return table(columns, rows)


def _quoted(key: str) -> Column[Compared]:
    return Column(f"paper_{key}", lambda row: row.quoted.numbers.get(key) if row.quoted else None)


def comparison_rows(block: Sequence[CellResults], methods: Sequence[str], paper: Paper) -> list[Compared]:
    """Compare the methods of one block: cells on the same seeds that differ in the method alone.

    Returns:
        The rows, best first by clean success and then by the mean time of all vehicles; those that are alike, and all
        where it is not known: ``methods`` in their order, then all others as they come.
    """
    reference = next((cell for cell in block if cell.first.method == REFERENCE), None)
    scenario, setting = block[0].first.scenario, setting_of(block[0].swept)
    # Its numbers do not stand below another number of vehicles or of seeds.
    paper = paper if block[0].as_in_paper else Paper()

    def driven(cell: CellResults) -> Compared:
        quoted = paper.row(cell.first.scenario, cell.first.method, cell.first.variant)
        pairs = None if cell is reference or reference is None else PairedCells(cell, reference)
        return Compared(cell.first.scenario, cell.first.method, DRIVEN, cell, quoted, cell.swept, pairs)

    rows: list[Compared] = []
    for method in methods:
        found = [driven(cell) for cell in block if takes_place_of(cell) == method]
        quoted = paper.row(scenario, method, "")
        rows += found or [Compared(scenario, method, MISSING, quoted=quoted, swept=setting)]
        # With rules in the place of its language model, a method is not set beside the paper's numbers.
        guided = quoted is not None and quoted.reasoner == "model" and method != REFERENCE
        if found and guided and not any(row.quoted for row in found):
            rows.append(Compared(scenario, method, QUOTED_ALONE, quoted=quoted, swept=setting))
    return _ranked(rows + [driven(cell) for cell in block if takes_place_of(cell) not in methods])


def with_corrected(rows: Sequence[Compared]) -> list[Compared]:
    """Correct the tests of all rows of a comparison for their number."""
    found = iter(corrected([row.pairs for row in rows if row.pairs]))
    return [replace(row, pairs=next(found)) if row.pairs else row for row in rows]


def _ranked(rows: Sequence[Compared]) -> list[Compared]:
    """Put the best first, and last what was not driven; the order stays where clean success is not known."""
    if not any(cell.judged for cell in _cells(rows)):
        return list(rows)
    driven = [(row.cell.standing, row) for row in rows if row.cell]
    return [*(row for _, row in sorted(driven, key=lambda pair: pair[0])), *(row for row in rows if not row.cell)]


def takes_place_of(cell: CellResults | None, name: str = "") -> str:
    """Return the method whose place in a table a cell takes; the name where there is none."""
    return place_of(cell.first.method, cell.first.reasoner) if cell else name


@dataclass(frozen=True)
class Condition:
    """A suite of which a comparison has a table of its own."""

    name: str
    sentence: str  # What its YAML says of it
    last: bool = True  # Whether notes that hold for every condition stand below its tables


WHOLE = Condition("", "")  # A comparison in one table


def print_comparison(
    rows: Sequence[Compared],
    metrics: str,
    swept: Sequence[str] = (),
    screen: bool = False,
    condition: Condition = WHOLE,
) -> PrintedTable:
    """Prepare the table of what was measured, the paper's row below each of ours.

    Args:
        screen: Whether it is for the screen, which shows computing times, too.
    """
    theirs = {index: paper_row(row.quoted) for index, row in enumerate(rows) if row.quoted}
    reasoners = [row.cell.first.reasoner for row in rows if row.cell]
    what = f"{condition.name}: comparison of methods" if condition.name else "comparison of methods"
    heading = title(what, [row.scenario for row in rows], reasoners, metrics)
    general = (
        NOTE,
        *clean_notes(_cells(rows)),
        *number_notes(_cells(rows)),
        *notes_of([(row.method, row.status, row.cell) for row in rows], screen),
    )
    notes = (*([condition.sentence] if condition.sentence else []), *(general if condition.last else ()))
    return printed(heading, comparison_table(rows, swept), [row.block for row in rows], notes, theirs, screen)


def notes_of(rows: Iterable[tuple[str, str, CellResults | None]], screen: bool) -> list[str]:
    """Say what a reader has to know of reasoners, missing methods and computing times."""
    rows = list(rows)
    missing, alone = (
        ", ".join(dict.fromkeys(method for method, status, _ in rows if status == which))
        for which in (MISSING, QUOTED_ALONE)
    )
    theirs = "the paper's go by a language model, the rows above by rules."
    return [
        *([FALLBACK_NOTE] if any(cell and cell.asked for *_, cell in rows) else []),
        *([ALGORITHM] if any(cell and cell.first.reasoner == "none" for *_, cell in rows) else []),
        *([f"{MISSING.capitalize()}: {missing}; there is no method of this name."] if missing else []),
        *stand_in_notes((cell.first.method, cell.first.reasoner) for *_, cell in rows if cell),
        *remarks(cell for *_, cell in rows if cell),
        *([f"{QUOTED_ALONE.capitalize()}: {alone}; {theirs}"] if alone else []),
        *([CPU_NOTE] if screen else []),
    ]


def print_pairs(
    rows: Sequence[Compared], metrics: str, swept: Sequence[str] = (), condition: Condition = WHOLE
) -> PrintedTable | None:
    """Prepare the table of differences to codriving on the same seeds.

    Returns:
        The table, with a note on every method that is better than codriving in something; None where there is no
        other method.
    """
    found = [row for row in rows if row.pairs]
    if not found:
        return None
    columns: list[Column[Any]] = [
        *status_columns(len({row.scenario for row in rows}) > 1),
        *swept_columns(swept),
        *(column.of(lambda r: r.pairs) for column in PAIRED),
    ]
    beaten = [_better_note(row, row.pairs, swept) for row in found if row.pairs and row.pairs.better] or [
        "No method is shown to be better than codriving in clean success, success, velocity or PET on these seeds."
    ]
    scenarios = ", ".join(dict.fromkeys(row.scenario for row in rows))
    named = f"{condition.name}: " if condition.name else ""
    heading = f"{named}against {REFERENCE} on the same seeds - {scenarios}{metrics_text(metrics)}"
    notes = (*_level_notes(found, swept), *beaten, *(PAIRED_NOTES if condition.last else ()))
    return printed(heading, table(columns, found), [row.block for row in found], notes)


def _level_notes(rows: Sequence[Compared], swept: Sequence[str]) -> list[str]:
    """Say of each block whether codriving is level with the best row in success and in clean success."""
    blocks: dict[tuple[object, ...], list[tuple[Compared, PairedCells]]] = {}
    for row in rows:
        if row.pairs:
            blocks.setdefault(row.block, []).append((row, row.pairs))
    notes = []
    for found in blocks.values():
        rates = {
            "Success": [(row, pairs.success) for row, pairs in found],
            "Clean success": [(row, pairs.clean) for row, pairs in found],
        }
        for measure, known in rates.items():
            row, best = max(known, key=lambda pair: pair[1].difference or 0.0)
            where = _where(row, swept) if len(blocks) > 1 else ""
            if not any(rate.pairs for _, rate in known):
                continue
            if not best.difference or best.difference < 0:
                notes.append(f"{measure}{where}: no row is above {REFERENCE}.")
                continue
            is_level = "level" if best.level else "not level"
            by = f"{points(best.difference)} points, p (Holm) = {p_text(best.corrected)}"
            notes.append(f"{measure}{where}: {REFERENCE} is {is_level} with the best row, {row.name} ({by}).")
    return notes


def _where(row: Compared, swept: Sequence[str]) -> str:
    return " at " + ", ".join([row.scenario, *(f"{key}={row.swept[key]}" for key in swept if row.swept.get(key))])


def _better_note(row: Compared, pairs: PairedCells, swept: Sequence[str]) -> str:
    texts = {column.key: column.text(column.value(pairs)) for column in PAIRED}
    shown = {
        "clean": f"clean success by {texts['clean_text']} points (p = {texts['clean_p_text']})",
        "success": f"success by {texts['success_difference']} points (p = {texts['mcnemar_p']})",
        "velocity": f"velocity by {texts['velocity']} m/s",
        "PET": f"PET by {texts['pet']} s",
    }
    where = _where(row, swept).removeprefix(" at ")
    return f"Better than codriving: {row.name} in {' and in '.join(shown[what] for what in pairs.better)} - {where}."


LOAD_NOTE = (
    "Rates are over completed episodes, with Wilson 95 % intervals; velocity is the mean over successful episodes."
)

# What the CSV gives at each number of CAVs.
AT_EACH = (
    *("completed", "success_rate", "success_low", "success_high", "pet_mean", "pet_below_1_5", "velocity_mean"),
    *("clean_rate", "clean_low", "clean_high"),
)


@dataclass(frozen=True, slots=True)
class LoadRow:
    """One method at all numbers of CAVs."""

    scenario: str
    method: str
    swept: Mapping[str, str]
    # Its cell at each number of CAVs; empty for a method that was not driven.
    at: dict[int, CellResults] = field(default_factory=dict)

    @property
    def cell(self) -> CellResults | None:
        """A cell that says of what method it is."""
        return next(iter(self.at.values()), None)

    @property
    def status(self) -> str:
        """Whether it could be driven."""
        return DRIVEN if self.at else MISSING

    @property
    def name(self) -> str:
        """The method, with its variant."""
        return self.cell.name if self.cell else self.method


def load_rows(cells: Sequence[tuple[int, CellResults]], methods: Sequence[str]) -> list[LoadRow]:
    """Put the cells of one method and setting into a row.

    Returns:
        The rows: those of a scenario and setting together, ``methods`` in their order, then all others as they come.
    """
    settings: dict[tuple[Value, ...], dict[tuple[Value, ...], LoadRow]] = {}
    for cavs, cell in cells:
        first = cell.first
        setting = settings.setdefault((first.scenario, *setting_of(cell.swept).values()), {})
        which = (first.method, first.variant, first.reasoner, cell.swept.get(METHOD_CHOICE))
        setting.setdefault(which, LoadRow(first.scenario, first.method, cell.swept)).at[cavs] = cell
    return list(chain.from_iterable(_in_order(list(setting.values()), methods) for setting in settings.values()))


def _in_order(rows: Sequence[LoadRow], methods: Sequence[str]) -> list[LoadRow]:
    ordered: list[LoadRow] = []
    for method in methods:
        found = [row for row in rows if takes_place_of(row.cell, row.method) == method]
        ordered += found or [LoadRow(rows[0].scenario, method, setting_of(rows[0].swept))]
    return [*ordered, *(row for row in rows if takes_place_of(row.cell, row.method) not in methods)]


def _measured(rows: Sequence[LoadRow]) -> list[Column[CellResults]]:
    """What people read at each number of CAVs."""
    return [
        Column("success", lambda c: _rate(c, "success"), "success (95 %)", csv=False),
        *([Column("clean", lambda c: _rate(c, "clean"), "clean (95 %)", csv=False)] if _known_clean(rows) else []),
        Column("velocity", lambda c: two_digits(BY_KEY["velocity_mean"].value(c)) or "-", "velocity [m/s]", csv=False),
        *([FALLBACKS] if any(cell.asked for row in rows for cell in row.at.values()) else []),
        Column("cpu", lambda c: milliseconds(c.cpu), CPU, csv=False, page=False),
    ]


def _of_method(rows: Sequence[LoadRow], swept: Sequence[str]) -> list[Column[Any]]:
    return [*status_columns(scenario=True), *swept_columns(swept), reasoner_column(rows)]


def load_table(rows: Sequence[LoadRow], loads: Sequence[int], swept: Sequence[str] = ()) -> Table:
    """Make the table of loads."""
    at_each = [*(replace(BY_KEY[key], head="") for key in AT_EACH), *_measured(rows)]
    episodes = Column[LoadRow]("episodes", lambda row: len(row.cell.records) if row.cell else None, "episodes")
    columns = [_at(cavs, column) for column in at_each for cavs in loads]
    return table([*_of_method(rows, swept), episodes, *columns], rows)


def _at(cavs: int, column: Column[CellResults]) -> Column[LoadRow]:
    head = f"{column.head}, {cavs} CAVs" if column.head else ""
    return column.of(lambda row: row.at.get(cavs), f"{column.key}_{cavs}", head)


def print_loads(rows: Sequence[LoadRow], loads: Sequence[int], metrics: str, swept: Sequence[str] = ()) -> PrintedTable:
    """Prepare the table of loads as a page has it."""
    notes = (LOAD_NOTE, *_load_notes(rows, screen=False))
    return printed(load_title(rows, metrics), load_table(rows, loads, swept), _load_blocks(rows), notes)


def print_each_load(
    rows: Sequence[LoadRow], loads: Sequence[int], metrics: str, swept: Sequence[str] = ()
) -> tuple[PrintedTable, ...]:
    """Prepare the tables of loads as a screen has them: one a quantity, computing times included."""
    notes = (LOAD_NOTE, *_load_notes(rows, screen=True))
    measured, heading = _measured(rows), load_title(rows, metrics)
    made = []
    for number, column in enumerate(measured, 1):
        columns = [replace(_at(cavs, column), head=f"{cavs} CAVs", brief=(f"{cavs} CAVs", " (")) for cavs in loads]
        found = table([*_of_method(rows, swept), *columns], rows)
        what = column.head if number > 1 else f"{heading} - {column.head}"
        made.append(printed(what, found, _load_blocks(rows), notes if number == len(measured) else (), screen=True))
    return tuple(made)


def _load_blocks(rows: Sequence[LoadRow]) -> list[tuple[object, ...]]:
    return [(row.scenario, *setting_of(row.swept).items()) for row in rows]


def _load_notes(rows: Sequence[LoadRow], screen: bool) -> list[str]:
    found = notes_of([(row.method, row.status, cell) for row in rows for cell in row.at.values() or [None]], screen)
    return [*clean_notes(cell for row in rows for cell in row.at.values()), *found]


def _known_clean(rows: Iterable[LoadRow]) -> bool:
    return any(cell.judged for row in rows for cell in row.at.values())


def load_title(rows: Sequence[LoadRow], metrics: str) -> str:
    """Say what is shown and who reasoned."""
    return title("load", [row.scenario for row in rows], [row.cell.first.reasoner for row in rows if row.cell], metrics)


def _rate(cell: CellResults, which: str) -> str:
    rate, low, high = (percent(BY_KEY[f"{which}_{key}"].value(cell)) for key in ("rate", "low", "high"))
    return f"{rate} ({low.removesuffix(' %')} to {high.removesuffix(' %')})" if low else "-"
