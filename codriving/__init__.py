"""Interactive and learnable cooperative driving, from a seed to the paper's tables."""

from typing import TYPE_CHECKING, Any

from codriving.version import __version__

if TYPE_CHECKING:
    from codriving.api import ablate, compare, learn, load, run, score
    from codriving.gym import ParallelDriving

__all__ = ["__version__", "ablate", "compare", "learn", "load", "parallel_env", "run", "score"]


def __getattr__(name: str) -> object:
    """Import a call with the first use of its name: what is behind them takes a second to import."""
    if name in __all__:
        from codriving import api

        return getattr(api, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """What completion offers, also before it is imported."""
    return sorted({*globals(), *__all__})


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
