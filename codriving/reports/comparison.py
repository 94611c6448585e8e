"""``comparison.*``: one row a method and scenario, missing methods included, each against the reference."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from codriving.metrics import FEWEST, RESAMPLES
from codriving.reports.columns import Column, Table, swept_columns, table
from codriving.reports.episodes import number_columns
from codriving.reports.pairs import PAIRED, PairedCells, PairedRate, corrected, p_text, paired_columns, points
from codriving.reports.paper import Paper, PaperRow
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.regret import HEAD, Above, above_columns, above_notes
from codriving.reports.results import CellResults, named_numbers
from codriving.reports.subject import METHODS, REFERENCE, Subject
from codriving.reports.summary import (
    BY_KEY,
    BY_MODEL,
    BY_MODEL_TEXTS,
    CLEAN,
    CPU,
    FALLBACK_NOTE,
    FALLBACKS,
    MEASURED,
    NOTE,
    clean_notes,
    decided_notes,
    number_notes,
    paper_row,
    remarks,
)
from codriving.reports.wording import (
    metrics_text,
    milliseconds,
    place_of,
    reasoner_text,
    stand_in_notes,
    title,
)

# Whether a method could be driven; the last for one that goes by a language model, where rules stood in for it.
DRIVEN, MISSING, QUOTED_ALONE = "driven", "not there yet", "only in the paper"

# The swept key that two methods of one name are told apart by; it belongs to a row, all others to a block.
METHOD_CHOICE = "method_choice"

ALGORITHM = "Reasoner none: an algorithm that has no reasoner. Rules are never a language model."
CPU_NOTE = "CPU: computing time of one decision for all CAVs, of this machine; it stands here and in timing.csv alone."

QUOTED = ("success_rate", "pet_mean", "pet_max", "pet_min", "velocity_mean", "velocity_max", "velocity_min")


def paired_notes(subject: Subject) -> tuple[str, ...]:
    """Say what the columns of differences mean."""
    return (
        f"Each difference is the {subject.row} minus {subject.reference} on the same seeds. Success and clean success: "
        "exact McNemar test, two-sided.",
        "Velocity and PET: means of an episode, over seeds on which both succeed; 95 % bootstrap intervals of "
        f"{RESAMPLES} resamples, where there are {FEWEST} pairs or more.",
        "Better or worse: p (Holm) below 0.05, or an interval without 0. Holm: corrected for the number of rows of the "
        "whole comparison, success and clean success each by itself; intervals are not corrected.",
        "Level: at most 3 points below the best that is no control, and not shown to be worse; of fewer than "
        f"{FEWEST} pairs nothing is said.",
    )


PAIRED_NOTES = paired_notes(METHODS)


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
    above: Above | None = None  # What it takes more than the bound of its scenes
    label: str = ""  # What it is called where its method and variant do not say what it differs in

    @property
    def name(self) -> str:
        """The method, with its variant."""
        return self.label or (self.cell.name if self.cell else self.method)

    @property
    def is_control(self) -> bool:
        """Whether it is no method."""
        return self.cell is not None and self.cell.is_control

    @property
    def block(self) -> tuple[object, ...]:
        """What it shares with all rows of its block."""
        return self.scenario, *setting_of(self.swept).items()


def setting_of(swept: Mapping[str, str]) -> Mapping[str, str]:
    """Give the swept keys that a cell shares with all cells of its block."""
    return {key: value for key, value in swept.items() if key != METHOD_CHOICE}


def _cells(rows: Iterable[Compared]) -> list[CellResults]:
    return [row.cell for row in rows if row.cell]


def _is_decided(rows: Iterable[Compared]) -> bool:
    return any(cell.decided for cell in _cells(rows))


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
        *(column.of(lambda row: row.cell) for column in (*BY_MODEL, *BY_MODEL_TEXTS) if _is_decided(rows)),
        *(above_columns() if any(row.above for row in rows) else []),
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


def ablation_rows(block: Sequence[CellResults]) -> list[Compared]:
    """Set each cell of one setting against the first one, which is the full method, in the order in which they come."""
    full, *others = block
    rows = [(full, None), *((cell, PairedCells(cell, full)) for cell in others)]
    return [
        Compared(cell.first.scenario, cell.first.method, DRIVEN, cell, None, cell.swept, pairs) for cell, pairs in rows
    ]


def ablation_table(rows: Sequence[Compared], swept: Sequence[str], subject: Subject) -> Table:
    """Make the table of what is lost by each removal."""
    columns: list[Column[Any]] = [
        *status_columns(len({row.scenario for row in rows}) > 1),
        *swept_columns(swept),
        *(column.of(lambda row: row.cell) for column in CLEAN),
        BY_KEY["success_rate"].of(lambda row: row.cell),
        *(column.of(lambda row: row.pairs) for column in paired_columns(subject.reference, "") if column.csv),
    ]
    return table(columns, rows)


def with_corrected(rows: Sequence[Compared]) -> list[Compared]:
    """Correct the tests of all rows of a comparison for their number."""
    found = iter(corrected([row.pairs for row in rows if row.pairs]))
    return [replace(row, pairs=next(found)) if row.pairs else row for row in rows]


def _ranked(rows: Sequence[Compared]) -> list[Compared]:
    """Put the best first, controls below the methods, and last what was not driven.

    Where clean success is not known, the order of methods and that of controls stay.
    """
    if not any(cell.judged for cell in _cells(rows)):
        return sorted(rows, key=lambda row: row.is_control)
    driven = [((row.is_control, *row.cell.standing), row) for row in rows if row.cell]
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
    subject: Subject = METHODS
    noted: tuple[Compared, ...] = ()  # The rows of all conditions, of which the notes below the last one speak


WHOLE = Condition("", "")  # A comparison in one table


def print_comparison(
    rows: Sequence[Compared],
    metrics: str,
    swept: Sequence[str] = (),
    screen: bool = False,
    condition: Condition = WHOLE,
    further: Sequence[str] = (),
) -> PrintedTable:
    """Prepare the table of what was measured, the paper's row below each of ours.

    Args:
        screen: Whether it is for the screen, which shows computing times, too.
        further: What else has to be said.
    """
    theirs = {index: paper_row(row.quoted) for index, row in enumerate(rows) if row.quoted}
    reasoners = [row.cell.first.reasoner for row in rows if row.cell]
    what = f"{condition.name}: " if condition.name else ""
    what += f"comparison of {condition.subject.rows}"
    heading = title(what, [row.scenario for row in rows], reasoners, metrics)
    heading += f" - {HEAD}" if any(row.above for row in rows) else ""
    noted = condition.noted or rows
    general = (
        *above_notes(noted),
        *further,
        *condition.subject.notes,
        NOTE,
        *clean_notes(_cells(noted)),
        *number_notes(_cells(noted)),
        *notes_of([(row.method, row.status, row.cell) for row in noted], screen),
    )
    notes = (*([condition.sentence] if condition.sentence else []), *(general if condition.last else ()))
    return printed(
        heading, comparison_table(rows, swept), [(row.block, row.is_control) for row in rows], notes, theirs, screen
    )


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
        *decided_notes(cell for *_, cell in rows if cell),
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
    found, subject = [row for row in rows if row.pairs], condition.subject
    if not found:
        return None
    paired = PAIRED if subject is METHODS else paired_columns(subject.reference, f"against {subject.reference}")
    columns: list[Column[Any]] = [
        *status_columns(len({row.scenario for row in rows}) > 1),
        *swept_columns(swept),
        *(column.of(lambda r: r.pairs) for column in paired),
    ]
    beaten = [_better_note(row, row.pairs, swept, subject) for row in found if row.pairs and row.pairs.better] or [
        f"No {subject.row} is shown to be better than {subject.reference} in clean success, success, velocity or PET "
        "on these seeds."
    ]
    scenarios = ", ".join(dict.fromkeys(row.scenario for row in rows))
    named = f"{condition.name}: " if condition.name else ""
    heading = f"{named}against {subject.reference} on the same seeds - {scenarios}{metrics_text(metrics)}"
    notes = (*_level_notes(found, swept, subject), *beaten, *(paired_notes(subject) if condition.last else ()))
    return printed(heading, table(columns, found), [(row.block, row.is_control) for row in found], notes)


def _level_notes(rows: Sequence[Compared], swept: Sequence[str], subject: Subject) -> list[str]:
    """Say of each block whether the reference is level with the best method, and which controls are above it.

    A control is not what the reference has to be level with: one of them is told what no vehicle can know.
    """
    blocks: dict[tuple[object, ...], list[tuple[Compared, PairedCells]]] = {}
    for row in rows:
        if row.pairs:
            blocks.setdefault(row.block, []).append((row, row.pairs))
    notes = []
    for found in blocks.values():
        where = _where(found[0][0], swept) if len(blocks) > 1 else ""
        for measure in ("success", "clean"):
            rates = [(row, getattr(pairs, measure)) for row, pairs in found]
            name = "Success" if measure == "success" else "Clean success"
            known = [(row, rate) for row, rate in rates if rate.pairs >= FEWEST]
            said = (_best_method(known, subject), _better_controls(known, subject))
            if any(said):
                notes.append(f"{name}{where}: {' '.join(filter(None, said))}")
    return notes


def _best_method(rates: Sequence[tuple[Compared, PairedRate]], subject: Subject) -> str:
    methods = [(row, rate) for row, rate in rates if not row.is_control]
    if not methods:
        return ""
    row, best = max(methods, key=lambda pair: pair[1].difference or 0.0)
    if (best.difference or 0.0) <= 0:
        return f"no {subject.row} is above {subject.reference}."
    level = "level" if best.level else "not level"
    return f"{subject.reference} is {level} with the best {subject.row}, {_by(row, best)}."


def _better_controls(rates: Sequence[tuple[Compared, PairedRate]], subject: Subject) -> str:
    above = [_by(row, rate) for row, rate in rates if row.is_control and (rate.difference or 0.0) > 0]
    return f"Controls above {subject.reference}: {', '.join(above)}." if above else ""


def _by(row: Compared, rate: PairedRate) -> str:
    return f"{row.name} ({points(rate.difference)} points, p (Holm) = {p_text(rate.corrected)})"


def _where(row: Compared, swept: Sequence[str]) -> str:
    return " at " + ", ".join([row.scenario, *(f"{key}={row.swept[key]}" for key in swept if row.swept.get(key))])


def _better_note(row: Compared, pairs: PairedCells, swept: Sequence[str], subject: Subject) -> str:
    texts = {column.key: column.text(column.value(pairs)) for column in PAIRED}
    shown = {
        "clean": f"clean success by {texts['clean_text']} points (p (Holm) = {texts['clean_holm']})",
        "success": f"success by {texts['success_difference']} points (p (Holm) = {texts['success_holm']})",
        "velocity": f"velocity by {texts['velocity']} m/s",
        "PET": f"PET by {texts['pet']} s",
    }
    where = _where(row, swept).removeprefix(" at ")
    better = " and in ".join(shown[what] for what in pairs.better)
    return f"Better than {subject.reference}: {row.name} in {better} - {where}."
