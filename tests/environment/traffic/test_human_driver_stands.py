"""A human driver who stands in the way for some time, and then drives on."""

from collections.abc import Callable

import pytest

from codriving.config.compose import compose
from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.drivers.style import DriverMix
from codriving.environment.environment import Environment
from codriving.experiment.objects import make_objects

Drive = Callable[..., Environment]
STARTS = [
    Start("CAV1", Kind.CAV, "south-north", 10.0, 5.0),
    Start("HDV1", Kind.HDV, "west-east", 85.0, 8.0),
    Start("HDV2", Kind.HDV, "west-east", 131.5, 0.0, stands=4.0),
]


def people() -> DriverMix:
    found = make_objects(compose(["drivers=rough"])).environment
    assert isinstance(found, Environment)
    assert isinstance(found.drivers, DriverMix)
    return found.drivers


@pytest.mark.parametrize("rough", [False, True])
def test_it_stands_as_long_as_it_is_told_and_drives_on(by_hand: Drive, rough: bool) -> None:
    environment = by_hand(starts=STARTS, people=people() if rough else None)
    environment.reset(0)
    for _ in range(20):
        environment.step({"CAV1": Action.IDLE})
    tracks = {track.id: track for track in environment.trajectory().tracks}
    standing, behind = tracks["HDV2"], tracks["HDV1"]
    assert set(standing.speed[:41]) == {0.0}
    assert set(standing.x[:41]) == {standing.x[0]}
    assert standing.x[0] == pytest.approx(20.5), "11 m from the middle to the exit, 7 m of room, half a car"
    assert 0 < standing.speed[41] < standing.speed[45]
    assert standing.speed[100] > 7.0, "it goes for the speed limit"
    assert (standing.kind, standing.style) == (Kind.HDV, "blocker")
    assert behind.style != "blocker"
    assert (standing.x - behind.x)[: len(behind.x)].min() > 5.0, "who follows sees it and stops"
    assert behind.speed[:60].min() < 5.0


def test_it_is_seen_as_any_other(by_hand: Drive) -> None:
    environment = by_hand(starts=STARTS)
    (seen,) = (vehicle for vehicle in environment.reset(0).vehicles if vehicle.id == "HDV2")
    assert (seen.kind, seen.speed, seen.acceleration) == (Kind.HDV, 0.0, 0.0)


def test_it_stands_also_when_it_drives_alone(by_hand: Drive) -> None:
    places = by_hand(starts=STARTS).alone(0)["HDV2"]
    assert set(places[:41]) == {131.5}
    assert places[45] > 131.5
