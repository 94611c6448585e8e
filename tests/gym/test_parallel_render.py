"""Pictures of the world that an agent is in."""

from collections.abc import Callable

import gymnasium
import numpy as np
import pytest
from choosers import FASTER, SLOWER

from codriving.animation.live import LivePicture
from codriving.datatypes.world import Action
from codriving.errors import EpisodeError
from codriving.gym.parallel import ParallelDriving

Make = Callable[..., ParallelDriving]


def test_a_picture_shows_what_has_changed_and_depends_on_the_seed_alone(make: Make) -> None:
    env = make(render_mode="rgb_array")
    env.reset(seed=1)
    first = env.render()
    assert first is not None
    assert (first.shape, first.dtype) == ((720, 1280, 3), np.uint8)
    env.step(dict.fromkeys(env.agents, FASTER))
    assert (env.render() != first).any()
    env.reset(seed=2)
    assert (env.render() != first).any()
    env.reset(seed=1)
    np.testing.assert_array_equal(env.render(), first)
    env.close()
    np.testing.assert_array_equal(env.render(), first)


def test_arrivals_are_on_the_panel_while_the_others_drive_on(make: Make) -> None:
    env = make(cavs=2, hdvs=(0, 0), render_mode="rgb_array")
    env.reset(seed=0)
    picture = LivePicture(env.environment.road_map, "intersection, seed 0")
    np.testing.assert_array_equal(env.render(), picture.draw(env.world))
    while "CAV1" in env.agents:
        env.step({"CAV1": FASTER, "CAV2": SLOWER})
    assert env.agents == ["CAV2"]
    (first, *_) = env.environment.trajectory().tracks
    assert first.arrived is not None
    actions = {"CAV1": Action.FASTER, "CAV2": Action.SLOWER}
    with_it, without = (picture.draw(env.world, actions, arrivals=known) for known in ({"CAV1": first.arrived}, {}))
    np.testing.assert_array_equal(env.render(), with_it)
    assert (with_it != without).any()


def test_no_render_mode_no_picture(make: Make) -> None:
    env = make(cavs=2)
    env.reset(seed=1)
    assert env.render() is None


def test_nothing_to_draw_before_the_first_episode(make: Make) -> None:
    with pytest.raises(EpisodeError, match="call reset"):
        make(render_mode="rgb_array").render()


def test_gymnasium_collects_pictures() -> None:
    env = gymnasium.make("codriving/intersection-v1", render_mode="rgb_array_list")
    env.reset(seed=1)
    env.step(np.ones(4, dtype=np.int64))
    frames = env.render()
    assert isinstance(frames, list)
    assert [frame.shape for frame in frames] == [(720, 1280, 3)] * 2
    assert env.metadata["render_fps"] == 2
    env.close()
