"""`codriving stress`: methods at rising levels of an axis, on the same seeds."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from codriving.commands.controls import split_controls
from codriving.commands.run import Command
from codriving.config import (
    ALL,
    CONTROLS,
    GROUPS,
    STRESS,
    Point,
    check_choice,
    choices,
    compose,
    expand,
    parse,
    sets_scenario,
    stress_axis,
    styles,
    taking_part,
    validate,
    written,
)
from codriving.datatypes import StressAxis
from codriving.errors import ConfigError
from codriving.experiment import Driven, Outputs, refuse_flows, results_of, shown_apart
from codriving.reports import (
    REFERENCE,
    CellResults,
    PrintedTable,
    StressCurve,
    breaking_table,
    markdown_text,
    print_stress,
    stress_figure,
    stress_notes,
    stress_table,
)

# What CAVs share in the rows of the reference: all, nothing negotiated, no intents, and states alone.
SHARED = ("cda=full", "cda=intent_sharing", "cda.intent_sharing=false", "cda=status_sharing")

USUAL = ("scenario=intersection", "episodes=60")  # As far as the user does not set it

NO_FLOWS = (
    "codriving stress pairs episodes, and in flows nothing is paired; write for instance codriving run "
    "scenario.cavs=2,4 flow=steady"
)


def stress_command(axes: str | None, config_dir: Path | None = None) -> Command:
    """Return the command for an axis, for several with commas between them, or for all."""
    known = choices(STRESS, config_dir)
    if not axes:
        raise ConfigError(
            f"stress needs the name of an axis; write codriving stress AXIS [KEY=VALUE]..., axes: {', '.join(known)}"
        )
    names = list(known) if axes == ALL else list(dict.fromkeys(axes.split(",")))
    found = [stress_axis(name, config_dir) for name in names]
    return Command(
        f"stress {axes}", partial(_checked_points, found), partial(refuse_flows, NO_FLOWS), partial(make_stress, found)
    )


def stress_points(axes: Sequence[StressAxis], overrides: Sequence[str], config_dir: Path | None = None) -> list[Point]:
    """Give the cells: each method at each level of each axis."""
    controlled, overrides = split_controls(written(overrides), usual=True)
    keys = [parse(token).key_or_group for token in overrides]
    for axis in axes:
        _refuse_varied(axis, keys)
    named = [*keys, *(["scenario"] if sets_scenario(overrides, config_dir) else [])]
    base = [token for token in ("experiment=stress", *USUAL) if token.partition("=")[0] not in named]
    others = [token for token, key in zip(overrides, keys, strict=True) if key != "method"]
    methods = [token for token, key in zip(overrides, keys, strict=True) if key == "method"]
    rows = _rows(methods, any(key.partition(".")[0] == "cda" for key in keys), config_dir)
    rows += [(name,) for name in taking_part(CONTROLS) if controlled and (name,) not in rows]
    settings, points = expand(others, config_dir), []
    for axis in axes:
        for point in settings:
            for method, *cda in rows:
                row = {"method": method, **dict(token.split("=") for token in cda)}
                for level, mark in zip(axis.levels, _marks(axis), strict=True):
                    tokens = (*base, *point.overrides, f"method={method}", *cda, *level.overrides)
                    points.append(Point(tokens, {**point.swept, **row, STRESS: mark}, point.removed))
    return points


def _checked_points(axes: Sequence[StressAxis], overrides: Sequence[str], config_dir: Path | None) -> list[Point]:
    """Refuse what is wrong with the first and the last cell alike before hundreds of others are composed."""
    points, said = stress_points(axes, overrides, config_dir), []
    for point in (points[0], points[-1]):
        try:
            validate(compose(point.overrides, config_dir))
        except ConfigError as err:
            said.append(err)
    if len(said) > 1 and str(said[0]) == str(said[1]):
        raise said[0]
    return points


def _rows(methods: Sequence[str], cooperates: bool, config_dir: Path | None) -> list[tuple[str, ...]]:
    """Give method and class of each row: those that the user names, or the usual ones.

    Args:
        methods: ``method=`` tokens.
        cooperates: Whether the user says how far CAVs cooperate, which then holds for all rows.
    """
    names = [point.overrides[0].partition("=")[2] for token in methods for point in expand([token], config_dir)]
    for name in names:
        check_choice("method", name, config_dir)
    if names:
        return [(name,) for name in dict.fromkeys(names)]
    rows: list[tuple[str, ...]] = []
    for name in taking_part(STRESS):
        several = name == REFERENCE and not cooperates
        rows += [(name, token) for token in SHARED] if several else [(name,)]
    return rows


def _refuse_varied(axis: StressAxis, keys: Sequence[str]) -> None:
    """Refuse keys that the axis sets."""
    varied = dict.fromkeys(parse(token).key_or_group for level in axis.levels for token in level.overrides)
    for key in keys:
        if key in varied or any(_holds(key, own) or _holds(own, key) for own in varied):
            raise ConfigError(f"{key} is what the axis {axis.key} varies; leave {key} out, or the axis")


def _holds(node: str, key: str) -> bool:
    """Whether a key is below another one, which is no choice of a group that leaves its keys to be set."""
    return node not in GROUPS and key.startswith(f"{node}.")


def _marks(axis: StressAxis) -> tuple[str, ...]:
    """What tells the levels of all axes apart, in tables and in names of folders."""
    return tuple(f"{axis.key} {label}" for label in axis.labels)


def make_stress(axes: Sequence[StressAxis], driven: Driven) -> Outputs:
    """Make tables and a figure for each axis."""
    curves = _curves(axes, driven)
    # Axes share the episodes of levels that are the same config, so that none is missing here.
    notes = (*stress_notes(curves), *(note for note in driven.notes if f"{STRESS}=" not in note))
    swept = tuple(dict.fromkeys(key for curve in curves for key in curve.swept))
    points, breaking = stress_table(curves, swept), breaking_table(curves, swept)
    files: dict[str, bytes] = {}
    pages: list[str] = []
    displays: list[PrintedTable] = []
    for axis in axes:
        own = [curve for curve in curves if curve.axis is axis]
        made = print_stress(own, driven.metrics, swept, notes if axis is axes[-1] else ())
        pages += [markdown_text(table, level=min(number, 2)) for number, table in enumerate(made, 1)]
        displays += made
        figure = stress_figure(own, driven.metrics, styles())
        files |= {f"figures/{name}": content for name, content in figure.items()}
    files |= {"stress.csv": points.csv().encode(), "breaking.csv": breaking.csv().encode()}
    return Outputs({**files, "stress.md": "\n".join(pages).encode()}, tuple(displays), (points, breaking))


def _curves(axes: Sequence[StressAxis], driven: Driven) -> list[StressCurve]:
    """Put the cells of one method and setting into a curve, in the order of the axes."""
    places = {mark: (axis.key, level) for axis in axes for level, mark in enumerate(_marks(axis))}
    found: dict[tuple[str, tuple[tuple[str, str], ...]], dict[int, CellResults]] = {}
    labels = {}
    for cell, records in zip(driven.cells, driven.records, strict=True):
        for point in cell.points:
            name, level = places[point[STRESS]]
            rest = tuple((key, value) for key, value in point.items() if key != STRESS)
            found.setdefault((name, rest), {})[level] = results_of(cell, records, {})
            labels[rest] = cell.labels
    shown = dict(zip(labels, shown_apart([(labels[rest], dict(rest)) for rest in labels]), strict=True))
    curves = []
    for axis in axes:
        for (name, rest), at in found.items():
            if name == axis.key:
                curves.append(StressCurve(axis, at, shown[rest]))
    return curves
