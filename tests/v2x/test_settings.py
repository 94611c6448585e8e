"""The settings of a channel: what is refused, and what the four choices are."""

from typing import Any

import pytest
from hearing import channel_settings

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.parts import Communication
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
        ({"distrust": 601}, "distrust must be 0 to 600 s, got 601"),
        ({"place_tolerance": -1}, "place_tolerance must be 0 to 50 m, got -1"),
        ({"route_tolerance": 21}, "route_tolerance must be 0 to 20 m, got 21"),
        ({"speed_tolerance": float("nan")}, "speed_tolerance must be 0 to 20 m/s2, got nan"),
    ],
)
def test_a_value_out_of_its_range_is_refused_with_the_range(change: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError) as refused:
        channel_settings(**change)
    assert str(refused.value) == said


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"ghost": 1.1}, "v2x.misbehaviour.ghost must be 0 to 1, got 1.1"),
        ({"lies_intent": -0.1}, "v2x.misbehaviour.lies_intent must be 0 to 1, got -0.1"),
        ({"along": 201}, "v2x.misbehaviour.along must be 0 to 200 m, got 201"),
        ({"across": 51}, "v2x.misbehaviour.across must be 0 to 50 m, got 51"),
        (
            {"ghost": 0.6, "never_answers": 0.5},
            "v2x.misbehaviour: lies_position, lies_intent, ghost, does_not_yield, never_answers must add up to at most "
            "1, since a CAV is of one kind, got 1.1",
        ),
    ],
)
def test_shares_of_misbehaviour_out_of_their_range_are_refused_by_their_full_name(
    change: dict[str, float], said: str
) -> None:
    node = compose(["v2x=good", *(f"v2x.misbehaviour.{key}={value}" for key, value in change.items())])["v2x"]
    with pytest.raises(ConfigError) as refused:
        build(node, Communication, "v2x")
    assert str(refused.value) == said


@pytest.mark.parametrize("name", ["cav1", "HDV1", "CAV0", "RSU"])
def test_an_emergency_vehicle_that_is_no_cav_is_refused(name: str) -> None:
    node = compose(["v2x=good", f"v2x.coordination.emergency={name}"])["v2x"]
    with pytest.raises(ConfigError) as refused:
        build(node, Communication, "v2x")
    said = f"v2x.coordination.emergency must be the name of a CAV, for instance CAV1, or null, got {name}"
    assert str(refused.value) == said


def test_no_cav_misbehaves_unless_it_is_asked_for() -> None:
    for name in CHOICES:
        found = compose([f"v2x={name}"])["v2x"]
        kinds = ("lies_position", "lies_intent", "ghost", "does_not_yield", "never_answers")
        assert [found["misbehaviour"][kind] for kind in kinds] == [0.0] * 5
        assert found["plausibility"] is False
