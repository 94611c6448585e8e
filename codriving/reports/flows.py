"""``summary.*`` of flows: one row a cell, means over seeds with bootstrap intervals; no success, nothing paired."""

from collections.abc import Iterable, Sequence
from typing import Any

from codriving.datatypes import Ending
from codriving.metrics import FEWEST, mean_interval, rate_interval
from codriving.reports.columns import Column, Table, Value, mean, swept_columns, table
from codriving.reports.episodes import MEMORY, counter_columns, number_columns
from codriving.reports.messages import message_columns
from codriving.reports.printed import PrintedTable, printed
from codriving.reports.results import LABELS, CellResults, ScoredEpisode, named_numbers
from codriving.reports.summary import ASKED_COLUMNS, BY_KEY, CPU, RunTables, labels, model_notes, remarks
from codriving.reports.wording import fixed, milliseconds, stand_in_notes, title

# What has an interval: key, its head, and decimals on the screen and in Markdown.
SHOWN = (
    ("throughput", "throughput [1/h]", 0),
    ("delay", "delay [s]", 1),
    ("velocity", "velocity [m/s]", 2),
    ("hard_braking", "hard braking [1/km]", 2),
)

COLLISIONS, PER = "collisions_per_1000", 1000

SUMS = ("collisions", "collisions_cavs", "off_road", "vehicles")  # What is added up over seeds

NOTES = (
    "Counted in the window alone: means over seeds, with 95 % bootstrap intervals over seeds where there are "
    f"{FEWEST} or more.",
    "Delay: time that all vehicles lose against driving alone, waiting outside included, for each that wants to come "
    "in. Waiting: vehicles outside at the end.",
    "Collisions: per 1,000 vehicles that leave the road; both are removed. Of none the interval is the rule of three.",
)

SEEDS: Column[CellResults] = Column("count", lambda c: _count(c), "seeds", csv=False, rank=6)


def flow_tables(cells: Sequence[CellResults], metrics: str, notes: Iterable[str] = ()) -> RunTables:
    """Make all tables of a run of flows."""
    swept = tuple(dict.fromkeys(key for cell in cells for key in cell.swept))
    episodes = table(_episode_columns(cells, swept), [episode for cell in cells for episode in cell.episodes])
    page, screen = (print_flows(cells, metrics, swept, notes, screen) for screen in (False, True))
    return RunTables(episodes, flow_table(cells, swept), page, screen)


def flow_table(cells: Sequence[CellResults], swept: Sequence[str] = ()) -> Table:
    """Make the table of flows."""
    columns: list[Column[Any]] = [
        *labels(cells, len({cell.first.scenario for cell in cells}) > 1),
        *swept_columns(swept),
        Column("episodes", lambda c: len(c.records)),
        Column("completed", lambda c: len(c.completed)),
        SEEDS,
        BY_KEY["error_rate"],
        Column("demand", lambda c: c.numbers.get("demand"), "demand [1/h]", lambda value: fixed(value, 0), rank=5),
        *(column for key, head, digits in SHOWN[:2] for column in _measured(key, head, digits)),
        *_columns(COLLISIONS, "collisions per 1,000", 1, _collision_rate, rank=1),
        Column("hits", _hits, "collisions (with a CAV)", csv=False, rank=3),
        *(column for key, head, digits in SHOWN[2:] for column in _measured(key, head, digits, rank=4)),
        Column("waiting", lambda c: c.numbers.get("waiting"), "waiting", fixed, rank=5),
        *(_mean_of(key) for key in ("delay_cavs", "delay_hdvs")),
        *(_sum_of(key) for key in SUMS),
        Column("cpu", lambda c: "" if c.cpu is None else milliseconds(c.cpu), CPU, csv=False, page=False, sparse=True),
    ]
    records = [record for cell in cells for record in cell.records]
    columns += [*number_columns(_others(cells), columns), *message_columns(cells)]
    columns += counter_columns(records, columns)
    return table([*columns, *(ASKED_COLUMNS if any(cell.asked for cell in cells) else ())], cells)


def print_flows(
    cells: Sequence[CellResults],
    metrics: str,
    swept: Sequence[str] = (),
    notes: Iterable[str] = (),
    screen: bool = False,
) -> PrintedTable:
    """Prepare the table of flows for people."""
    firsts = [cell.first for cell in cells]
    scenarios = [first.scenario for first in firsts]
    models = stand_in_notes((first.method, first.reasoner) for first in firsts)
    said = (*NOTES, *models, *remarks(cells), *model_notes(cells), *notes)
    heading = title("flow", scenarios, [first.reasoner for first in firsts], metrics)
    return printed(heading, flow_table(cells, swept), scenarios, said, screen=screen)


def _episode_columns(cells: Sequence[CellResults], swept: Sequence[str]) -> list[Column[Any]]:
    records = [record for cell in cells for record in cell.records]
    known: list[Column[Any]] = [
        *(column.of(lambda e: e.record) for column in LABELS),
        Column("seed", lambda e: e.record.seed),
        Column("outcome", lambda e: e.record.outcome.ending.value, words=True),
        *swept_columns(swept),
        Column("duration", lambda e: None if _failed(e) else e.record.outcome.time),
        Column("decisions", lambda e: e.record.decisions),
        Column("message", lambda e: e.record.outcome.message or None, words=True),
        *([MEMORY] if any(record.memory for record in records) else []),
    ]
    known += number_columns(named_numbers(cells), known)
    return [*known, *counter_columns(records, known)]


def _failed(episode: ScoredEpisode) -> bool:
    return episode.record.outcome.ending is Ending.ERROR


def _measured(key: str, head: str, digits: int, rank: int = 0) -> list[Column[CellResults]]:
    def value(cell: CellResults) -> tuple[Value, Value, Value]:
        return cell.numbers.get(key), *(mean_interval(_each(cell, key)) or (None, None))

    return _columns(key, head, digits, value, rank)


def _columns(key: str, head: str, digits: int, value: Any, rank: int) -> list[Column[CellResults]]:  # noqa: ANN401
    """The columns of a number, of its limits, and of all three as a text."""

    def text(cell: CellResults) -> str:
        middle, low, high = (fixed(number, digits) for number in value(cell))
        return f"{middle} ({low} to {high})" if low else middle or "-"

    return [
        Column(key, lambda c: value(c)[0]),
        Column(f"{key}_low", lambda c: value(c)[1]),
        Column(f"{key}_high", lambda c: value(c)[2]),
        Column(f"{key}_text", text, f"{head} (95 %)", csv=False, rank=rank, brief=(head, " (")),
    ]


def _collision_rate(cell: CellResults) -> tuple[Value, Value, Value]:
    """The rate over all seeds together, since a seed of a sparse flow has few vehicles."""
    collisions, vehicles = _each(cell, "collisions"), _each(cell, "vehicles")
    if not sum(vehicles):
        return None, None, None
    rate, limits = PER * sum(collisions) / sum(vehicles), rate_interval(collisions, vehicles)
    return (rate, None, None) if limits is None else (rate, PER * limits[0], PER * limits[1])


def _hits(cell: CellResults) -> str:
    return "{:.0f} ({:.0f})".format(*(sum(_each(cell, key)) for key in SUMS[:2]))


def _each(cell: CellResults, key: str) -> list[float]:
    """A number of each seed in which it is defined."""
    return [value for episode in cell.completed if (value := episode.numbers.get(key)) is not None]


def _mean_of(key: str) -> Column[CellResults]:
    return Column(key, lambda c: mean(_each(c, key)))


def _sum_of(key: str) -> Column[CellResults]:
    return Column(key, lambda c: sum(_each(c, key)))


def _others(cells: Sequence[CellResults]) -> list[Any]:
    """Numbers of a metric of the user's."""
    own = {"demand", "delay_cavs", "delay_hdvs", "waiting", COLLISIONS, *SUMS}
    return [number for number in named_numbers(cells) if number.name not in own | {key for key, *_ in SHOWN}]


def _count(cell: CellResults) -> str:
    completed, planned = len(cell.completed), len(cell.records)
    return str(planned) if completed == planned else f"{completed}/{planned}"
