"""Episodes to the tables of a comparison: ``comparison.*``, ``load.*`` and the figure."""

from collections.abc import Callable, Iterator, Mapping
from functools import partial

from codriving.config.choices import TAKING_PART
from codriving.config.locate import experiments_dir
from codriving.experiment.cells import Cell
from codriving.experiment.comparison import ALL, BASELINES, CAVS, LOAD, SINGLE_VEHICLE, setting
from codriving.experiment.further import Driven, Further
from codriving.reports.comparison import METHOD_CHOICE, TEXT, Entry, comparison_columns, comparison_rows, swept_keys
from codriving.reports.comparison_display import measured_display
from codriving.reports.load import load_columns, load_rows
from codriving.reports.load_display import load_display
from codriving.reports.load_figure import load_figure
from codriving.reports.markdown import markdown_text
from codriving.reports.model_columns import FALLBACK_RATE
from codriving.reports.pairs_display import paired_display
from codriving.reports.paper import read_paper
from codriving.reports.run_tables import Table
from codriving.reports.timing_table import cpu_per_decision


def methods(table: str, driven: Driven) -> Further:
    """Make a comparison of methods.

    Returns:
        ``comparison.csv`` and ``comparison.md``, and what is printed: the same with computing times.
    """
    paper, metrics = read_paper(experiments_dir()), driven.metrics
    blocks: dict[str, list[Entry]] = {}
    for cell, entry in _entries(driven):
        blocks.setdefault(setting(cell.resolved), []).append(entry)
    rows = [row for block in blocks.values() for row in comparison_rows(block, TAKING_PART[table], paper)]
    swept = swept_keys(entry for block in blocks.values() for entry in block)
    model = any(FALLBACK_RATE in row.row for row in rows)
    whole = Table(comparison_columns(swept, model), tuple(row.row for row in rows), swept, TEXT)
    kept, printed = (measured_display(rows, paper, metrics, swept, cpu) for cpu in (False, True))
    against = paired_display(rows, metrics, swept)
    page = markdown_text(kept) + (f"\n{markdown_text(against, level=2)}" if against else "")
    files = {"comparison.csv": whole.csv().encode(), "comparison.md": page.encode()}
    return Further(files, (printed, against) if against else (printed,), (whole,))


def load(driven: Driven) -> Further:
    """Make the table and the figure of loads.

    Returns:
        ``load.csv``, ``load.md`` and ``figures/load.*``, and what is printed: the table with computing times.
    """
    cells = [(int(cell.resolved["scenario"]["cavs"]), entry) for cell, entry in _entries(driven, without=CAVS)]
    loads = list(dict.fromkeys(cavs for cavs, _ in cells))
    rows = load_rows(cells, TAKING_PART[LOAD])
    swept = swept_keys(entry for _, entry in cells)
    model = any(row.model for row in rows)
    table = Table(load_columns(loads, swept, model), tuple(row.row() for row in rows), swept, TEXT)
    kept, printed = (load_display(rows, loads, driven.metrics, swept, cpu) for cpu in (False, True))
    files = {"load.csv": table.csv().encode(), "load.md": markdown_text(kept).encode()}
    figures = {f"figures/{name}": content for name, content in load_figure(rows, loads, driven.metrics).items()}
    return Further({**files, **figures}, (printed,), (table,))


FURTHER: Mapping[str, Callable[[Driven], Further]] = {
    **{table: partial(methods, table) for table in (BASELINES, SINGLE_VEHICLE, ALL)},
    LOAD: load,
}
"""What makes each table of ``codriving compare``."""


def _entries(driven: Driven, without: str = "") -> Iterator[tuple[Cell, Entry]]:
    dropped = {without}
    if len({_told(cell) for cell in driven.cells}) == len(driven.cells):
        dropped.add(METHOD_CHOICE)
    for cell, records, timings in zip(driven.cells, driven.records, driven.timings, strict=True):
        swept = {key: value for key, value in cell.swept.items() if key not in dropped}
        yield cell, Entry(records, swept, cpu_per_decision(timings))


def _told(cell: Cell) -> tuple[object, ...]:
    """What tells a row from the others without the choice of its method."""
    return (cell.labels, *(pair for pair in cell.swept.items() if pair[0] != METHOD_CHOICE))
