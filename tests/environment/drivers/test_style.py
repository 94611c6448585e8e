"""Each style of drivers shows in what its drivers do, beside attentive drivers in the same place."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from drivers_at_work import Crossing

from codriving.datatypes.record import Ending
from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.drivers.style import DriverMix
from codriving.environment.environment import Environment
from codriving.environment.termination import Termination

Mix = Callable[..., DriverMix]
Cross = Callable[..., Crossing]

# From the south, who has to give way to those from the west; the CAV would be at the crossing 1.5 s later.
COMES, HAS_PRIORITY = ("south-north", 70.0, 8.0), ("west-east", 61.5, 8.0)


def stood(crossing: Crossing) -> float:
    """How long HDV1 stood [s]."""
    return float((crossing.speeds < 0.5).sum()) * 0.1


def test_an_attentive_driver_waits_for_who_has_priority(people: Mix, cross: Cross) -> None:
    found = cross(people("attentive"), HDV1=COMES, CAV1=HAS_PRIORITY)
    assert found.ending is Ending.SUCCESS
    assert found.lines["HDV1"] > found.lines["CAV1"] + 1.5
    assert found.speeds.min() < 2.0


@pytest.mark.parametrize("style", ["nonyielding", "aggressive"])
def test_others_go_first_without_the_right_to(style: str, people: Mix, cross: Cross) -> None:
    found = cross(people(style), HDV1=COMES, CAV1=HAS_PRIORITY)
    assert found.lines["HDV1"] < found.lines["CAV1"] - 0.5
    assert found.speeds.min() == pytest.approx(8.0, abs=0.1)


def test_only_who_never_gives_way_drives_on_before_a_vehicle_that_is_near(people: Mix, cross: Cross) -> None:
    nearer = ("west-east", 70.0, 8.0)
    pushes, never = (cross(people(style), HDV1=COMES, CAV1=nearer) for style in ("aggressive", "nonyielding"))
    assert (pushes.ending, never.ending) == (Ending.SUCCESS, Ending.COLLISION)
    assert pushes.lines["HDV1"] > pushes.lines["CAV1"] + 1.5
    # Bodies in its way it does mind: it brakes, too late.
    assert never.speeds.min() < 7.5


def test_a_hesitant_driver_lets_others_go_first_until_it_has_stood_for_5_s(people: Mix, cross: Cross) -> None:
    def never_comes(env: Environment) -> None:
        """The CAV drives at 6 m/s and yet stays where it is, 12 m before its line."""
        cav = next(v for v in env._traffic.vehicles if v.id == "CAV1")
        cav.position[:] = cav.route_path.path.position(88.0)
        cav.s, cav.speed, cav.target_speed = 88.0, 6.0, 6.0

    vehicles = {"HDV1": ("west-east", 60.0, 7.0), "CAV1": ("south-north", 88.0, 6.0)}
    attentive, hesitant = (cross(people(style), never_comes, **vehicles) for style in ("attentive", "hesitant"))
    assert attentive.speeds.min() == pytest.approx(7.0, abs=0.1)
    assert 5.0 <= stood(hesitant) <= 7.0
    assert hesitant.lines["HDV1"] < 20.0


def test_a_distracted_driver_sees_crossing_traffic_later(people: Mix, cross: Cross) -> None:
    vehicles = {"HDV1": ("south-north", 40.0, 6.0), "CAV1": ("west-east", 40.0, 6.0)}
    attentive, distracted = (cross(people(style), **vehicles) for style in ("attentive", "distracted"))
    assert attentive.ending is distracted.ending is Ending.SUCCESS
    assert distracted.brakes - attentive.brakes == pytest.approx(1.2, abs=0.25)


def test_a_distracted_driver_follows_as_attentively_as_others(people: Mix, cross: Cross) -> None:
    vehicles = {"HDV1": ("south-north", 20.0, 9.0), "CAV1": ("south-north", 38.0, 3.0)}
    attentive, distracted = (cross(people(style), **vehicles) for style in ("attentive", "distracted"))
    assert attentive.speeds.min() < 5.0
    assert np.array_equal(attentive.speeds, distracted.speeds)


def test_a_driver_reacts_to_who_drives_ahead_a_reaction_time_late(
    people: Mix, by_hand: Callable[..., Environment]
) -> None:
    begin = {}
    for reaction in (0.0, 0.8):
        mix = people("attentive", reaction=(reaction, reaction))
        starts = [Start("CAV1", Kind.CAV, "south-north", 50.0, 8.0), Start("HDV1", Kind.HDV, "south-north", 30.0, 8.0)]
        env = by_hand(starts=starts, people=mix)
        env.reset(0)
        for action in (*[Action.IDLE] * 2, *[Action.SLOWER] * 4):
            env.step({"CAV1": action})
        pedals = next(track.acceleration for track in env.trajectory().tracks if track.id == "HDV1")
        begin[reaction] = float(np.flatnonzero(pedals[11:] < pedals[10] - 0.3)[0]) * 0.1
    assert begin[0.8] - begin[0.0] == pytest.approx(0.8, abs=0.15)


def test_patience_ends_a_wait_for_a_vehicle_that_stands_in_the_junction(people: Mix, cross: Cross) -> None:
    # It stands a little over the line, clear of the driver's way, and never moves.
    vehicles = {"HDV1": ("south-north", 70.0, 6.0), "CAV1": ("west-east", 108.6, 0.0)}
    patient, usual = (cross(people("attentive", patience=(p, p)), **vehicles) for p in (600.0, 8.0))
    assert patient.lines["HDV1"] == float("inf")
    assert 8.0 <= stood(usual) <= 10.0
    assert usual.lines["HDV1"] < 20.0


def test_people_on_a_ramp_stop_where_they_can_still_turn_out_of_it(configured: Callable[..., Environment]) -> None:
    crowd = ("scenario.hdvs=[12,12]", "scenario.ramp_hdvs=0.5", "scenario.cavs=2")
    env = configured("scenario=merge", "drivers=attentive", *crowd)
    for seed in (10_004, 10_006, 10_007):
        scene = env.scenario.scene(seed)
        traffic = env._populated(replace(scene, starts=tuple(s for s in scene.starts if s.kind is Kind.HDV)))
        judge = Termination(["none"], 100.0, 0.1)
        for step in range(600):
            traffic.act()
            traffic.step(0.1)
            judge.check(traffic, step * 0.1)
        assert (traffic.vehicles, judge._bystanders) == ([], [])


@pytest.mark.parametrize(("signals", "waits"), [(1.0, False), (0.0, True)])
def test_who_does_not_signal_is_taken_to_go_straight_on(signals: float, waits: bool, people: Mix, cross: Cross) -> None:
    # HDV2 turns right, so that it does not cross the way of HDV1, which cannot know it but by the signal.
    vehicles = {
        "HDV1": ("south-north", 66.0, 8.0),
        "HDV2": ("west-south", 70.0, 8.0),
        "CAV1": ("north-south", 20.0, 0.0),
    }
    found = cross(people("attentive", signals), **vehicles)
    assert bool(found.speeds[:45].min() < 3.0) is waits
