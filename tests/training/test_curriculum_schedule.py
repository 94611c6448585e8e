"""Numbers that change along a training."""

import pytest

from codriving.errors import ConfigError
from codriving.training.curriculum import Linear


@pytest.mark.parametrize(("decisions", "value"), [(0, 1.0), (50, 0.55), (100, 0.1), (10_000, 0.1), (-5, 1.0)])
def test_a_straight_line_and_then_its_end(decisions: int, value: float) -> None:
    assert Linear(1.0, 0.1, 100).at(decisions) == pytest.approx(value)


def test_no_length_is_refused() -> None:
    with pytest.raises(ConfigError, match="over must be 1 or more"):
        Linear(1.0, 0.1, 0)
