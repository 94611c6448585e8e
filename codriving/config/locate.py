"""Where the configs are: inside an installed package, or at the top level of the repository."""

from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent  # The installed or checked-out package `codriving`

_INSTALLED = (PACKAGE / "_conf").is_dir()


def conf_dir() -> Path:
    """Return the folder of the config groups."""
    return PACKAGE / "_conf" if _INSTALLED else PACKAGE.parent / "conf"


def experiments_root() -> Path:
    """Return the folder in which ``experiments`` lies, as a search path needs it."""
    return PACKAGE / "_experiments" if _INSTALLED else PACKAGE.parent


def experiments_dir() -> Path:
    """Return the folder of the paper's tables: one YAML each, and the paper's own numbers as CSV."""
    return experiments_root() / "experiments"
