"""Interactive and learnable cooperative driving, from a seed to the paper's tables."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from codriving.experiment import Results

__all__ = ["__version__", "run"]

__version__ = "0.1.0"


def run(*overrides: str, config_dir: str | Path | None = None) -> "Results":
    """Drive a seeded batch, as ``codriving run`` does, and return its tables as data frames.

    Args:
        *overrides: ``key=value`` tokens, for instance ``"scenario=intersection", "episodes=5"``.
        config_dir: A folder with YAML files of your own, in the same groups.

    Returns:
        ``episodes`` and ``summary`` as pandas data frames, and the run ``folder``.

    Raises:
        UserError: If the config or the run folder cannot be used.

    Example:
        >>> results = codriving.run("scenario=intersection", "episodes=5")  # doctest: +SKIP
        >>> results.summary[["success_rate", "velocity_mean"]]  # doctest: +SKIP
    """
    from codriving.experiment import run_frames

    return run_frames(*overrides, config_dir=None if config_dir is None else Path(config_dir))
