"""Whether a driver lets a CAV pass that goes on, in worlds that were driven by hand."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from worlds import Junction, car

from codriving.datatypes.parts import Simulator
from codriving.datatypes.record import Track, Trajectory
from codriving.datatypes.world import Action, Kind, WorldState
from codriving.judgement.contests import Contest, contests
from codriving.judgement.going_on import CLEARS, entered, lets_pass


@dataclass
class Driven(Simulator):
    """A world in which all keep their speed, whatever is done."""

    junction: Junction
    starts: Mapping[str, tuple[str, float, float]]  # Route, place and speed of each vehicle
    ends: tuple[float, Any] = (99.0, None)
    time: float = 0.0
    actions: list[Mapping[str, Action]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.road_map = self.junction.road_map

    @property
    def outcome(self) -> Any:
        return self.ends[1] if self.time >= self.ends[0] else None

    def reset(self, seed: int) -> WorldState:
        raise NotImplementedError

    def step(self, actions: Mapping[str, Action]) -> WorldState:
        self.actions.append(actions)
        self.time += 0.5
        return self.junction.world(car("CAV1", "south-north", 1.0, 1.0), time=self.time)

    def trajectory(self) -> Trajectory:
        times = 0.1 * np.arange(round(self.time / 0.1) + 1)
        return Trajectory(0.1, tuple(self._track(name, *start, times) for name, start in self.starts.items()))

    def _track(self, name: str, route: str, place: float, speed: float, times: Any) -> Track:
        path, s = self.road_map.paths[route], place + speed * times
        x, y = path.position(s)
        kind = Kind.CAV if name.startswith("CAV") else Kind.HDV
        return Track(name, kind, route, 0, x, y, path.heading(s), 0 * s + speed, 0 * s, ("",) * len(s), None)


def asked(junction: Junction) -> Contest:
    """CAV1 from the south, and HDV1 across its way."""
    world = junction.world(car("CAV1", "east-west", 80.0, 8.0, 9.0), car("HDV1", "south-north", 76.0, 8.0))
    [contest] = contests(junction.think(world).moment())
    return contest


def deliberation(time: float, gap: float | None = None, drives: bool = True, thinks: bool = False) -> Any:
    ahead = None if gap is None else SimpleNamespace(gap=gap)
    scene = SimpleNamespace(ego=SimpleNamespace(id="CAV1", speed=8.0), next_in=lambda role: ahead)
    actions = {"CAV2": Action.IDLE} | ({"CAV1": Action.SLOWER} if drives else {})
    return SimpleNamespace(time=time, actions=actions, situations=[SimpleNamespace(scene=scene)] * (not thinks))


def answered(world: Driven, contest: Contest, **told: Any) -> bool | None:
    return lets_pass(world, lambda state: deliberation(state.time, **told), deliberation(0.0, **told), contest)


@pytest.mark.parametrize(("place", "expected"), [(60.0, True), (90.0, False), (-60.0, True)])
def test_who_is_first_when_the_cav_goes_on(place: float, expected: bool, junction: Junction) -> None:
    world = Driven(junction, {"CAV1": ("east-west", 80.0, 8.0), "HDV1": ("south-north", place, 8.0)})
    assert answered(world, asked(junction)) is expected
    assert {(a["CAV1"], a["CAV2"]) for a in world.actions} == {(Action.FASTER, Action.IDLE)}
    if expected:  # Then 2 s more are driven, in which both might collide
        times = entered(world, asked(junction))
        assert world.time == pytest.approx(np.ceil(2 * times[0][0]) / 2 + CLEARS + 0.5)


def test_who_comes_nowhere_says_nothing(junction: Junction) -> None:
    world = Driven(junction, {"CAV1": ("east-west", 80.0, 0.0), "HDV1": ("south-north", 60.0, 0.0)})
    assert answered(world, asked(junction)) is None
    assert len(world.actions) == 24


def test_behind_a_vehicle_that_is_near_the_cav_does_as_the_method_does(junction: Junction) -> None:
    for gap, action in ((16.0, Action.SLOWER), (16.1, Action.FASTER)):
        world = Driven(junction, {"CAV1": ("east-west", 80.0, 8.0), "HDV1": ("south-north", 60.0, 8.0)})
        assert answered(world, asked(junction), gap=gap) is True
        assert {a["CAV1"] for a in world.actions} == {action}


def test_a_driver_who_collides_with_the_cav_has_not_let_it_pass(junction: Junction) -> None:
    starts = {"CAV1": ("east-west", 80.0, 8.0), "HDV1": ("south-north", 60.0, 8.0)}
    for failed, expected in ((("HDV1", "CAV1"), False), (("HDV2", "CAV1"), True)):
        world = Driven(junction, starts, ends=(3.5, SimpleNamespace(failed=failed)))
        assert answered(world, asked(junction)) is expected
        assert len(world.actions) == 7


def test_a_cav_that_does_not_drive_any_more_ends_it(junction: Junction) -> None:
    world = Driven(junction, {"CAV1": ("east-west", 80.0, 8.0), "HDV1": ("south-north", 60.0, 8.0)})
    assert answered(world, asked(junction), drives=False) is None
    assert len(world.actions) == 1


def test_a_cav_whose_method_still_thinks_goes_on(junction: Junction) -> None:
    world = Driven(junction, {"CAV1": ("east-west", 80.0, 8.0), "HDV1": ("south-north", 60.0, 8.0)})
    assert answered(world, asked(junction), gap=1.0, thinks=True) is True
    assert {a["CAV1"] for a in world.actions} == {Action.FASTER}
