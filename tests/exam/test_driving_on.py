"""What comes of an answer: times that are lost, drivers drawn anew, and copies that leave the world as it is."""

from copy import deepcopy

import numpy as np
import pytest

import codriving.exam.driving_on as driving_on
from codriving.datatypes.record import Track, Trajectory
from codriving.datatypes.world import Action, Kind
from codriving.exam.building import _objects, worlds
from codriving.exam.driving_on import Copied, lost
from codriving.exam.observed import notebook_of
from codriving.judgement.contests import contests
from codriving.reasoning.perception import Moment


def track(x: list[float], speed: float, arrived: float | None = None, style: str = "") -> Track:
    n = len(x)
    zeros = np.zeros(n)
    return Track(
        "v", Kind.CAV, "r", 0, np.array(x), zeros, zeros, zeros + speed, zeros, ("",) * n, arrived, style=style
    )


def test_time_that_is_lost() -> None:
    # 2 s at 5 m/s against 10 m/s: 1 s lost; then 5 m/s slower, which takes 25 / (2 * 2 * 10) = 0.625 s to make up for.
    slow = track([0.0, 5.0, 10.0], 5.0)
    assert lost(Trajectory(1.0, (slow,)), 0.0, 2.0, 10.0) == pytest.approx(1.625)
    assert lost(Trajectory(1.0, (slow,)), 1.0, 2.0, 10.0) == pytest.approx(0.5 + 0.625)
    there = track([0.0, 5.0, 10.0, 15.0], 5.0, arrived=1.0)
    assert lost(Trajectory(1.0, (there,)), 0.0, 3.0, 10.0) == pytest.approx(0.5)
    assert lost(Trajectory(1.0, (track([0.0, 0.0], 0.0, style="blocker"),)), 0.0, 1.0, 10.0) == 0.0


def test_a_copy_is_driven_on_and_the_world_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(driving_on, "DRAWS", 1)
    monkeypatch.setattr(driving_on, "HORIZON", 1.5)
    environment, methods = _objects(worlds()["standoff"])
    world = environment.reset(20_000)
    for method in methods:
        method.reset(environment.road_map, environment.driving_model, 1)
    for _ in range(5):
        world = environment.step(methods[0].act(world).actions)
        methods[1].act(world)
    notebook = notebook_of(methods[0])
    notebook.empty()
    notebook.closed = False
    copied = Copied(environment, methods, world, 20_000)
    before = environment.trajectory()
    methods[0].act(world)
    situation, _ = max(notebook.situations, key=lambda found: len(found[0].allowed))
    judged = copied.of_actions(situation)
    assert list(judged) == list(situation.allowed)
    assert {one.drives for one in judged.values()} == {2}
    assert min(one.loss for one in judged.values()) == 0.0
    assert judged[Action.SLOWER].loss > 0
    (posed,) = notebook.posed[:1]
    pair = posed.conflicts[0].ego, posed.conflicts[0].other
    both = copied.of_orders(pair)
    assert sorted(one.loss for one in both)[0] == 0.0
    assert notebook.forced == {}
    driven, kept = (copied.copy(methods[0])[0] for _ in range(2))
    driven.step(dict.fromkeys(world.available, Action.FASTER))
    assert driven.road_map is kept.road_map is environment.road_map
    assert driven.trajectory().tracks[0].x.size > kept.trajectory().tracks[0].x.size == before.tracks[0].x.size
    assert [len(t.x) for t in environment.trajectory().tracks] == [len(t.x) for t in before.tracks]


@pytest.mark.parametrize("name", ["poor_radio", "slow_mind"])
def test_drivers_are_asked_where_a_method_shares_or_thinks(name: str) -> None:
    environment, methods = _objects(worlds()[name])
    world = environment.reset(20_000)
    for method in methods:
        method.reset(environment.road_map, environment.driving_model, 1)
    notebook = notebook_of(methods[0])
    notebook.closed = False
    moments: list[Moment] = []
    while not moments or not contests(moments[-1]):
        copied = Copied(environment, deepcopy(methods, {id(part): part for part in environment.lasting}), world, 1)
        notebook.empty()
        actions = methods[0].act(world).actions
        moments = [moment for _, moment in notebook.situations if moment is not None]
        world = environment.step(actions) if not moments or not contests(moments[-1]) else world
    assert {copied.lets_pass(contest) for moment in moments for contest in contests(moment)} == {True}
    assert environment.trajectory().tracks[0].x.size == round(world.time / environment.trajectory().step) + 1
