"""Fixtures for all rooms, and makes ``worlds`` importable."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import hydra
import pytest
from hypothesis import settings

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.environment.environment import Environment

HERE = str(Path(__file__).parent)
if HERE not in sys.path:
    sys.path.insert(0, HERE)

from composed import composed_once  # noqa: E402  (needs the path above)
from thorough import THOROUGH  # noqa: E402
from worlds import Junction  # noqa: E402

# The same commit has to pass or fail alike everywhere; with DRAWN=1 (make check-all) new examples are drawn every time.
# How long an example takes says only how busy the machine is.
settings.register_profile("drawn", deadline=None)
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("drawn" if THOROUGH else "repeatable")


@pytest.fixture(scope="session", autouse=True)
def composed_anew() -> Iterator[Any]:
    """Hydra's own ``compose``; meanwhile configs are composed once, but for thorough tests."""
    composed = hydra.compose
    with pytest.MonkeyPatch.context() as patch:
        if not THOROUGH:
            patch.setattr(hydra, "compose", composed_once(composed))
        yield composed


@pytest.fixture(scope="session")
def configured() -> Callable[..., Environment]:
    """Builds the environment that some overrides ask for, in the world of version 0.1 unless they name another."""

    def make(*overrides: str) -> Environment:
        environment = build(compose(["suite=paper", *overrides])["environment"], object)
        assert isinstance(environment, Environment)
        return environment

    return make


@pytest.fixture(scope="session")
def junction(configured: Callable[..., Environment]) -> Junction:
    """The intersection of the configuration, and worlds on it made by hand."""
    return Junction(configured("scenario=intersection"))


@pytest.fixture(scope="session")
def highway(configured: Callable[..., Environment]) -> Junction:
    """The highway of the configuration, and worlds on it made by hand."""
    return Junction(configured("scenario=highway"))


@pytest.fixture(scope="session")
def merge(configured: Callable[..., Environment]) -> Junction:
    """The merge of the configuration, and worlds on it made by hand."""
    return Junction(configured("scenario=merge"))


@pytest.fixture(scope="session")
def roundabout(configured: Callable[..., Environment]) -> Junction:
    """The roundabout of the configuration, and worlds on it made by hand."""
    return Junction(configured("scenario=roundabout"))


@pytest.fixture(scope="session")
def road(configured: Callable[..., Environment]) -> Callable[[str], Junction]:
    """The road of a scenario, by name, and worlds on it made by hand."""
    known: dict[str, Junction] = {}

    def named(name: str) -> Junction:
        if name not in known:
            known[name] = Junction(configured(f"scenario={name}"))
        return known[name]

    return named
