"""The settings of a channel: what is refused, and what the four choices are."""

from typing import Any

import pytest
from hearing import channel_settings

from codriving.config.compose import compose
from codriving.errors import ConfigError

KEYS = ("rate", "age", "age_shape", "loss", "burst", "range", "noise", "speed_noise", "validity")

CHOICES: dict[str, tuple[float, ...]] = {
    "good": (10.0, 0.1, 0.0, 0.01, 1.0, 300.0, 0.1, 0.05, 3.0),
    "urban": (10.0, 0.3, 2.0, 0.1, 3.0, 150.0, 0.3, 0.1, 3.0),
    "poor": (10.0, 1.0, 0.0, 0.3, 3.0, 50.0, 0.3, 0.1, 3.0),
}


@pytest.mark.parametrize("name", CHOICES)
def test_the_channels_are_as_they_were_fixed(name: str) -> None:
    found = compose([f"v2x={name}"])["v2x"]
    assert tuple(found[key] for key in KEYS) == CHOICES[name]
    assert [found[f"{kind}_bytes"] for kind in ("cam", "cpm", "object", "mcm")] == [350, 240, 35, 300]


def test_by_default_there_is_no_channel() -> None:
    assert compose([])["v2x"] is None
    assert compose(["v2x=perfect"])["v2x"] is None


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"rate": 0.4}, "rate must be 0.5 to 100 Hz, got 0.4"),
        ({"age": -0.1}, "age must be 0 to 10 s, got -0.1"),
        ({"age_shape": 101}, "age_shape must be 0 to 100, got 101"),
        ({"loss": 1.0}, "loss must be 0 to 0.99, got 1"),
        ({"burst": 0.5}, "burst must be 1 to 1000, got 0.5"),
        ({"range": 10_001}, "range must be 0 to 10000 m, got 10001"),
        ({"noise": 11}, "noise must be 0 to 10 m, got 11"),
        ({"speed_noise": float("nan")}, "speed_noise must be 0 to 10 m/s, got nan"),
        ({"validity": 61}, "validity must be 0 to 60 s, got 61"),
        ({"cam_bytes": -1}, "cam_bytes must be 0 to 100000, got -1"),
        ({"mcm_bytes": 100_001}, "mcm_bytes must be 0 to 100000, got 100001"),
    ],
)
def test_a_value_out_of_its_range_is_refused_with_the_range(change: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError) as refused:
        channel_settings(**change)
    assert str(refused.value) == said
