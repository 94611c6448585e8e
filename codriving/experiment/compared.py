"""Episodes to the tables of a comparison: ``comparison.*``, ``load.*`` and the figure."""

from collections.abc import Callable, Iterator, Mapping
from functools import partial

from codriving.config.choices import TAKING_PART
from codriving.config.locate import experiments_dir
from codriving.experiment.cells import Cell
from codriving.experiment.comparison import ALL, BASELINES, CAVS, LOAD, SINGLE_VEHICLE, setting
from codriving.experiment.further import Driven, Further
from codriving.reports.comparison import METHOD_CHOICE, comparison_rows, comparison_table, print_comparison, print_pairs
from codriving.reports.figures import load_figure
from codriving.reports.load import load_rows, load_table, print_loads
from codriving.reports.paper import read_paper
from codriving.reports.printed import markdown_text
from codriving.reports.results import CellResults
from codriving.reports.timing import cpu_per_decision


def methods(table: str, driven: Driven) -> Further:
    """Make a comparison of methods.

    Returns:
        ``comparison.csv`` and ``comparison.md``, and what is printed: the same with computing times.
    """
    paper, metrics = read_paper(experiments_dir()), driven.metrics
    blocks: dict[str, list[CellResults]] = {}
    for cell, results in _results(driven):
        blocks.setdefault(setting(cell.resolved), []).append(results)
    rows = [row for block in blocks.values() for row in comparison_rows(block, TAKING_PART[table], paper)]
    swept = tuple(dict.fromkeys(key for block in blocks.values() for results in block for key in results.swept))
    whole = comparison_table(rows, swept)
    kept, printed = (print_comparison(rows, metrics, swept, screen) for screen in (False, True))
    against = print_pairs(rows, metrics, swept)
    page = markdown_text(kept) + (f"\n{markdown_text(against, level=2)}" if against else "")
    files = {"comparison.csv": whole.csv().encode(), "comparison.md": page.encode()}
    return Further(files, (printed, against) if against else (printed,), (whole,))


def load(driven: Driven) -> Further:
    """Make the table and the figure of loads.

    Returns:
        ``load.csv``, ``load.md`` and ``figures/load.*``, and what is printed: the table with computing times.
    """
    cells = [(int(cell.resolved["scenario"]["cavs"]), results) for cell, results in _results(driven, without=CAVS)]
    loads = list(dict.fromkeys(cavs for cavs, _ in cells))
    rows = load_rows(cells, TAKING_PART[LOAD])
    swept = tuple(dict.fromkeys(key for _, results in cells for key in results.swept))
    table = load_table(rows, loads, swept)
    kept, printed = (print_loads(rows, loads, driven.metrics, swept, screen) for screen in (False, True))
    files = {"load.csv": table.csv().encode(), "load.md": markdown_text(kept).encode()}
    figures = {f"figures/{name}": content for name, content in load_figure(rows, loads, driven.metrics).items()}
    return Further({**files, **figures}, (printed,), (table,))


FURTHER: Mapping[str, Callable[[Driven], Further]] = {
    **{table: partial(methods, table) for table in (BASELINES, SINGLE_VEHICLE, ALL)},
    LOAD: load,
}
"""What makes each table of ``codriving compare``."""


def _results(driven: Driven, without: str = "") -> Iterator[tuple[Cell, CellResults]]:
    dropped = {without}
    if len({_told(cell) for cell in driven.cells}) == len(driven.cells):
        dropped.add(METHOD_CHOICE)
    for cell, records, timings in zip(driven.cells, driven.records, driven.timings, strict=True):
        swept = {key: value for key, value in cell.swept.items() if key not in dropped}
        yield cell, CellResults(records, swept, cpu=cpu_per_decision(timings), metric=cell.metrics)


def _told(cell: Cell) -> tuple[object, ...]:
    """What tells a row from the others without the choice of its method."""
    return (cell.labels, *(pair for pair in cell.swept.items() if pair[0] != METHOD_CHOICE))
