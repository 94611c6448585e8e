"""The settings of an experiment: what its file sets, once for each of its columns, and what the command line adds."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from codriving.config import ExperimentFile, Point, expand, key_of, sets_scenario


def points_of(
    spec: ExperimentFile,
    overrides: Sequence[str],
    config_dir: Path | None = None,
    named: bool = False,
    make: Callable[[Sequence[str], Path | None], Sequence[Point]] = expand,
) -> list[Point]:
    """Give a config for each column, and for each value of what is swept.

    Args:
        named: Whether a column is told from others by its name; else by the keys that it sets.
        make: Makes the configs of one column.
    """
    given = [key_of(token) for token in overrides]
    # A suite that is about one scenario takes the place of those that the file names.
    given += ["scenario"] if sets_scenario(overrides, config_dir) else []
    common, columns = spec.settings(given)
    found = []
    for name, tokens in columns.items():
        told = {"column": name} if named else {key_of(token): token.partition("=")[2] for token in tokens}
        for point in make([*common, *tokens, *overrides], config_dir):
            found.append(replace(point, swept={**(told if len(columns) > 1 else {}), **point.swept}))
    return found
