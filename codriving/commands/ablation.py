"""`codriving ablate`: each sub-module of the reasoning removed, and controls, against the full method."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from codriving.commands.compare import conditions_of
from codriving.commands.controls import ablation_controls, split_controls
from codriving.commands.run import Command
from codriving.commands.settings import points_of
from codriving.config import SUITE, ExperimentFile, Point, built_in
from codriving.errors import ConfigError
from codriving.experiment import Cell, Driven, Outputs, Plan, results_of
from codriving.reports import (
    REFERENCE,
    CellResults,
    Compared,
    DrawnRow,
    Subject,
    ablation_rows,
    ablation_table,
    markdown_text,
    print_pairs,
    profile_figure,
    rate_figure,
    setting_of,
    with_corrected,
)

# What each cell of the ablation changes.
REMOVALS: tuple[tuple[str, ...], ...] = tuple(built_in("ablate").rows.values())

SUBJECT = Subject("ablations", "row", "full")


def ablation_points(
    overrides: Sequence[str], config_dir: Path | None = None, spec: ExperimentFile | None = None
) -> list[Point]:
    """Take the sub-modules of the reasoning module out of each config in turn; then come the controls.

    Args:
        spec: Says what is removed from what; None takes that of the command.
    """
    removals = REMOVALS if spec is None else tuple(spec.rows.values())
    spec = spec or built_in("ablate")
    wanted, overrides = split_controls([*spec.words, *overrides], usual=True)
    rows = []
    for p in points_of(spec, overrides, config_dir):
        rows += [Point((*p.overrides, *removal), p.swept, removal) for removal in removals]
        rows += ablation_controls(p, REFERENCE, config_dir) if wanted else []
    return rows


def refuse_alike(plan: Plan) -> None:
    """A method that does not reason has nothing to remove; its ablation would be one row many times over."""
    together: defaultdict[tuple[str, ...], list[Cell]] = defaultdict(list)
    for cell in plan.cells:
        together[cell.labels.scenario, cell.labels.method, *cell.swept.values()].append(cell)
    for cells in together.values():
        if len(cells) > 1 and len({cell.labels for cell in cells}) == 1:
            raise ConfigError(
                f"method {cells[0].labels.method!r} has no reasoning sub-modules to remove; choose one that has, "
                "method=codriving"
            )


def make_ablation(driven: Driven) -> Outputs:
    """Set each row against the full method on the same seeds: what it costs to take a sub-module away."""
    if driven.flows:
        return Outputs()
    settings: dict[tuple[object, ...], list[CellResults]] = {}
    for cell, records in zip(driven.cells, driven.records, strict=True):
        setting = (cell.labels.scenario, *cell.swept.items())
        settings.setdefault(setting, []).append(results_of(cell, records, cell.swept))
    rows = with_corrected([row for block in settings.values() for row in ablation_rows(block)])
    swept = tuple(dict.fromkeys(key for row in rows for key in row.swept))
    conditions = conditions_of(rows, SUBJECT, driven.config_dir)
    printed = []
    for condition, members in conditions:
        keys = tuple(key for key in swept if not condition.name or key != SUITE)
        against = print_pairs(members, driven.metrics, keys, condition)
        if against:
            sentence = [condition.sentence] if condition.sentence else []
            printed.append(replace(against, notes=(*sentence, *against.notes)))
    table = ablation_table(rows, swept, SUBJECT)
    pages = "\n".join(markdown_text(page, level=1 if page is printed[0] else 2) for page in printed)
    files = {"ablation.csv": table.csv().encode(), "ablation.md": pages.encode()}
    drawn = [DrawnRow(row.name, _panel(row), row.cell) for row in rows if row.cell]
    figures = rate_figure(drawn, "ablation", driven.metrics)
    files |= {f"figures/{name}": content for name, content in figures.items()}
    if len(conditions) > 1:
        figures = profile_figure([(c.name, members) for c, members in conditions], driven.metrics)
        files |= {f"figures/{name}": content for name, content in figures.items()}
    return Outputs(files, tuple(printed), (table,), below=True)


def _panel(row: Compared) -> str:
    return "\n".join([row.scenario, *(f"{key}={value}" for key, value in setting_of(row.swept).items())])


ABLATE = Command("ablate", ablation_points, refuse_alike, make_ablation)
