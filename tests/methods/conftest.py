"""Builds the method at any CDA level."""

from collections.abc import Callable
from typing import Any

import pytest
from worlds import FULL, Junction

from codriving.llm.language_model import Offline
from codriving.methods.codriving import CoDriving
from codriving.reasoning.sharing.sharing import CdaLevel


@pytest.fixture(scope="session")
def method(junction: Junction) -> Callable[..., CoDriving]:
    """Builds the method, ready for an episode at the junction; toggles that differ from full are named."""

    def make(seed: int = 0, **change: Any) -> CoDriving:
        made = CoDriving(CdaLevel(**{**FULL, **change}), Offline(), None, 1.6)
        made.reset(junction.road_map, junction.model, seed)
        return made

    return make
