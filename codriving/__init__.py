"""Interactive and learnable cooperative driving, from a seed to the paper's tables."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from codriving.version import __version__

if TYPE_CHECKING:
    from codriving.commands import Comparison, Results
    from codriving.gym import ParallelDriving

__all__ = ["__version__", "compare", "parallel_env", "run"]


def run(*overrides: str, config_dir: str | Path | None = None) -> "Results":
    """Drive a seeded batch, as ``codriving run`` does, and return its tables as data frames.

    Args:
        *overrides: ``key=value`` tokens, for instance ``"scenario=intersection", "episodes=5"``.

    Returns:
        ``episodes`` and ``summary`` as pandas data frames, and the run ``folder``.

    Raises:
        UserError: If the config or the run folder cannot be used.

    Example:
        >>> results = codriving.run("scenario=intersection", "episodes=5")  # doctest: +SKIP
        >>> results.summary[["success_rate", "velocity_mean"]]  # doctest: +SKIP
    """
    from codriving.commands import run_frames

    return run_frames(*overrides, config_dir=config_dir)


def compare(table: str, *overrides: str, config_dir: str | Path | None = None) -> "Comparison":
    """Drive every method of the paper on the same seeds, as ``codriving compare`` does, and return the tables.

    Args:
        table: ``"baselines"``, ``"single-vehicle"``, ``"all"`` or ``"load"``.
        *overrides: ``key=value`` tokens; ``"method=mine"`` adds a method of your own.

    Returns:
        ``table``, ``episodes`` and ``summary`` as pandas data frames, and the run ``folder``.

    Raises:
        UserError: If the table, the config or the run folder cannot be used.

    Example:
        >>> results = codriving.compare("baselines", "episodes=20")  # doctest: +SKIP
        >>> results.table[["method", "success_rate", "mcnemar_p"]]  # doctest: +SKIP
    """
    from codriving.commands import compare_frames

    return compare_frames(table, *overrides, config_dir=config_dir)


def parallel_env(name: str, *overrides: str, **settings: Any) -> "ParallelDriving":  # noqa: ANN401 - any setting
    """Make an environment in which every CAV is an agent, with the interface of PettingZoo.

    The same, with one agent that decides for all CAVs: ``gymnasium.make("codriving.gym:codriving/<name>-v1")``.

    Args:
        name: Name of the scenario, for instance ``"roundabout"``.
        *overrides: ``key=value`` tokens, for instance ``"drivers=rough"``.
        **settings: ``cda``, ``rows``, ``coordinates``, ``normalise``, ``reward``, ``render_mode`` and ``config_dir``,
            as :class:`codriving.gym.parallel.ParallelDriving` describes them; all others are keys of the scenario,
            for instance ``cavs=4``.

    Raises:
        ConfigError: If a setting cannot be used.

    Example:
        >>> env = codriving.parallel_env("intersection", cavs=6, cda="status_sharing")  # doctest: +SKIP
        >>> observations, infos = env.reset(seed=0)  # doctest: +SKIP
    """
    from codriving.gym import ParallelDriving

    return ParallelDriving(name, *overrides, **settings)
