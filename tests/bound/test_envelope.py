"""What tells worlds apart, and where their envelopes are found."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from codriving.bound.envelope import Envelope, alike, load, read, text_of, world_hash
from codriving.bound.world import BoundedWorld, bounded_world
from codriving.config.build import build
from codriving.config.compose import compose
from codriving.environment import Environment
from codriving.errors import ConfigError


def environment(*overrides: str) -> Environment:
    found = build(compose(overrides)["environment"], object)
    assert isinstance(found, Environment)
    return found


def test_road_control_limits_and_actions_tell_worlds_apart_and_crowds_do_not() -> None:
    own = world_hash(environment())
    others = [
        "scenario.exit_distance=30",
        "environment.control.heading=4",
        "limits.lateral=5",
        "scenario.target_speeds=[0,4.5,9]",
        "scenario.decision_frequency=1",
    ]
    hashes = [world_hash(environment(one)) for one in others]
    assert len({own, *hashes}) == 6
    assert world_hash(environment("scenario.blind=8")) == own
    assert world_hash(environment("scenario.cavs=8", "drivers=rough", "environment.steady=false")) == own


def test_routes_of_one_shape_share_an_envelope(world: Callable[..., BoundedWorld]) -> None:
    at = world("scenario=intersection")
    assert alike(at.environment.road_map)["west-north"] == alike(at.environment.road_map)["south-west"]
    assert len(set(alike(at.environment.road_map).values())) == 3
    assert at.envelopes is not None
    assert at.envelopes["west-north"] is at.envelopes["south-west"]


def test_values_are_rounded_away_from_what_was_seen(tmp_path: Path, world: Callable[..., BoundedWorld]) -> None:
    ones = np.ones(2)
    seen = Envelope(0.00001, 9.00001 * ones, -0.12345 * ones, 0.12341 * ones, -0.00001 * ones, 0.2 * ones)
    road_map = world("scenario=intersection").environment.road_map
    (tmp_path / "one.csv").write_text(text_of(dict.fromkeys(set(alike(road_map).values()), seen)))
    one = read(tmp_path / "one.csv", road_map)["north-south"]
    assert (one.lead, one.pace[0], one.left[1], one.right[0], one.least_turn[0], one.most_turn[0]) == (
        pytest.approx((0.0001, 9.0001, -0.1235, 0.1235, -0.0001, 0.2))
    )


def test_world_that_was_not_measured_is_refused_with_the_cure(tmp_path: Path) -> None:
    other = environment("scenario.exit_distance=30")
    with pytest.raises(ConfigError, match="measure it with codriving bound --measure"):
        load(other, tmp_path)
    with pytest.raises(ConfigError, match="no envelope was measured"):
        bounded_world(other)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (("flow=steady",), "for a flow"),
        (("scenario.blocked_exit=10", "scenario.cavs=6"), "at a blocked exit"),
    ],
)
def test_where_no_bound_is_defined_it_says_so(overrides: tuple[str, ...], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        bounded_world(environment(*overrides))
