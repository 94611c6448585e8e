"""Each vehicle alone on the road."""

import numpy as np
import pytest

from codriving.config.compose import compose
from codriving.environment import environment as environment_module
from codriving.environment.environment import Environment
from codriving.experiment.objects import make_objects


def _environment(*overrides: str) -> Environment:
    found = make_objects(compose(list(overrides))).environment
    assert isinstance(found, Environment)
    return found


@pytest.mark.parametrize("scenario", ["intersection", "roundabout", "merge", "highway"])
@pytest.mark.parametrize("limits", ["none", "road"])
def test_each_gets_to_its_goal_and_the_same_way_each_time(scenario: str, limits: str) -> None:
    environment = _environment(f"scenario={scenario}", f"limits={limits}")
    scene, alone = environment.scenario.scene(10000), environment.alone(10000)
    assert list(alone) == [start.id for start in scene.starts]
    for start in scene.starts:
        places = alone[start.id]
        assert places[0] == start.position
        assert places[-1] >= environment.road_map.routes[start.route].goal > places[-2]
        assert (np.diff(places) >= 0).all()
    environment_module._ALONE.clear()
    again = environment.alone(10000)
    assert all((again[name] == places).all() for name, places in alone.items())


def test_it_is_worked_out_once_for_all_methods_in_one_world() -> None:
    first = _environment("method=codriving").alone(10000)
    assert _environment("method=fcfs").alone(10000) is first
    other = _environment("method=fcfs", "environment.control.speed=1.2").alone(10000)
    assert any(len(other[name]) != len(first[name]) for name in first)


def test_a_cav_speeds_up_as_its_speed_law_lets_it() -> None:
    """From 7 m/s towards 9 m/s with a = 1.6 (9 - v), in steps of 0.1 s: 7, 7 + 0.32 = 7.32, 7.32 + 0.2688 = 7.5888 m/s.

    Targets are 3 m/s apart, so that a CAV at 7 m/s aims at 9 m/s at once; the first step still has the speed at start.
    """
    environment = _environment("scenario=intersection", "scenario.cav_speed=[7,7]", "scenario.hdvs=[0,0]")
    for places in environment.alone(10000).values():
        assert np.diff(places)[:3] * 10 == pytest.approx([7, 7.32, 7.5888], abs=0.01)


def test_limits_make_it_slower_where_the_route_bends() -> None:
    free, limited = (
        _environment("scenario=intersection", f"limits={limits}").alone(10000) for limits in ("none", "road")
    )
    assert all(len(limited[name]) >= len(free[name]) for name in free)
    assert any(len(limited[name]) > len(free[name]) + 5 for name in free)


def test_an_episode_is_not_disturbed() -> None:
    environment = _environment("scenario=intersection")
    world = environment.reset(10000)
    environment.alone(10001)
    actions = {name: available[0] for name, available in world.available.items()}
    after = environment.step(actions)
    environment.reset(10000)
    assert environment.step(actions) == after
