"""A CAV does not enter a junction past which there is no room for it, and gets out of one in which it stands."""

from collections.abc import Callable

import pytest
from driven import Episode, drive, planned
from worlds import FULL, Junction, Thoughts, car

from codriving.datatypes.parts import Method
from codriving.datatypes.record import Ending
from codriving.datatypes.world import Kind, Start
from codriving.environment.environment import Environment
from codriving.llm.language_model import Offline
from codriving.methods.codriving import CoDriving
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.methods.ordered import Ordered
from codriving.reasoning.exits import boxes, full_exit, gets_out
from codriving.reasoning.safety.conflict_lane import check_exit
from codriving.reasoning.sharing.sharing import CdaLevel
from codriving.reasoning.sharing.tracking import Tracking

BOX = (101.2, 120.8)
"""Where a vehicle that goes straight on is in the way of others, to a decimetre [m]."""


@pytest.fixture(scope="module")
def steady(configured: Callable[..., Environment]) -> Junction:
    return Junction(configured("scenario=intersection", "environment.steady=true"))


def codriving() -> Method:
    return CoDriving(CdaLevel(**FULL), Offline(), None, 1.5)


def fcfs() -> Method:
    return Ordered(FirstComeFirstServed(), planned())


def farthest(junction: Junction, episode: Episode, name: str, until: float) -> float:
    """How far a vehicle came on its way north until a time [s]."""
    track = next(track for track in episode.trajectory.tracks if track.id == name)
    rows = slice(0, round(until / 0.1))
    return max(s for s, _ in junction.road_map.paths["south-north"].project_all(track.x[rows], track.y[rows]))


def queue() -> tuple[Start, ...]:
    """A human driver stands past the exit for 15 s, with room for one vehicle; two CAVs come, and one crosses."""
    return (
        Start("CAV1", Kind.CAV, "south-north", 65.0, 6.0),
        Start("CAV2", Kind.CAV, "south-north", 50.0, 6.0),
        Start("CAV3", Kind.CAV, "west-east", 40.0, 6.0),
        Start("HDV1", Kind.HDV, "south-north", 132.0, 0.0, stands=15.0),
    )


@pytest.mark.parametrize("method", [codriving, fcfs])
def test_a_full_exit_is_not_entered(method: Callable[[], Method], junction: Junction, steady: Junction) -> None:
    entered, waited = (drive(world.drive(*queue()), method(), 0) for world in (junction, steady))
    assert BOX[0] + 0.3 < farthest(junction, entered, "CAV2", 14.5) < BOX[1], "it stands in the way of others"
    assert farthest(steady, waited, "CAV2", 14.5) < BOX[0]
    assert farthest(steady, waited, "CAV1", 14.5) > BOX[1], "there is room for it"
    assert waited.outcome is not None
    assert waited.outcome.ending is Ending.SUCCESS
    assert waited.outcome.arrivals["CAV3"] < 14.5


def exit_of(junction: Junction, *cars: tuple[str, str, float, float]) -> tuple[str, float] | None:
    thoughts = junction.thoughts(*(car(name, route, place, speed) for name, route, place, speed in cars))
    known = thoughts.scenes["CAV1"].vehicles()
    return full_exit(thoughts.moment(), known, known["CAV1"])


@pytest.mark.parametrize(
    ("place", "others", "full"),
    [
        (80.0, [("HDV1", "south-north", 127.0, 0.0)], True),
        (80.0, [("HDV1", "south-north", 128.0, 0.0)], False),
        (80.0, [("HDV1", "south-north", 127.0, 0.6)], False),
        (80.0, [("HDV1", "south-north", 132.0, 0.0), ("CAV2", "south-north", 90.0, 6.0)], True),
        (80.0, [("HDV1", "south-north", 132.0, 0.0), ("CAV2", "south-north", 70.0, 6.0)], False),
        (80.0, [("HDV1", "south-north", 132.0, 0.0), ("CAV2", "east-north", 106.0, 6.0)], True),
        (80.0, [("HDV1", "south-north", 132.0, 0.0), ("CAV2", "east-north", 90.0, 6.0)], False),
        (80.0, [("HDV1", "west-east", 127.0, 0.0)], False),
        (102.0, [("HDV1", "south-north", 127.0, 0.0)], False),
        (98.0, [("HDV1", "south-north", 127.0, 0.0)], False),
    ],
    ids=[
        "no room", "room", "it drives", "room for one, who is ahead", "behind", "in the junction", "not in it yet",
        "another exit", "in the junction already", "cannot stop any more",
    ],
)  # fmt: skip
def test_when_an_exit_is_full(
    place: float, others: list[tuple[str, str, float, float]], full: bool, junction: Junction, steady: Junction
) -> None:
    found = exit_of(steady, ("CAV1", "south-north", place, 6.0), *others)
    assert found == (("HDV1", pytest.approx(101.2, abs=0.05)) if full else None)
    assert exit_of(junction, ("CAV1", "south-north", place, 6.0), *others) is None


@pytest.mark.parametrize(
    ("place", "removed"),
    [
        (80.0, ""),
        (90.0, "FASTER"),
        (94.0, "FASTER HOLD IDLE"),
        (97.0, ""),  # It cannot stop any more
    ],
)
def test_actions_after_which_it_could_not_stop_before_the_junction_are_removed(
    place: float, removed: str, junction: Junction, steady: Junction
) -> None:
    cars = car("CAV1", "south-north", place, 6.0), car("HDV1", "south-north", 127.0, 0.0)
    found = check_exit(steady.safety_input(*cars))
    assert " ".join(sorted(found)) == removed
    assert check_exit(junction.safety_input(*cars)) == {}


def test_only_those_who_cross_others_are_in_the_way(steady: Junction) -> None:
    (box,) = boxes(steady.road_map, "south-north")
    assert box == pytest.approx(BOX, abs=0.05)
    assert boxes(steady.road_map, "south-east") == ()


def waiting(world: Junction, seconds: float, *cars: tuple[str, str, float]) -> Thoughts:
    """What is thought once some vehicles have been standing for a while."""
    tracking, placed = Tracking(world.road_map), [car(name, route, place, 0.0) for name, route, place in cars]
    for k in range(round(seconds / 0.5) + 1):
        thoughts = world.think(world.world(*placed, time=k * 0.5, step=k), tracking=tracking)
    return thoughts


def passes(world: Junction, seconds: float, first: bool, other: tuple[str, str, float], place: float = 105.0) -> bool:
    thoughts = waiting(world, seconds, ("CAV1", "south-north", place), other)
    known = thoughts.scenes["CAV1"].vehicles()
    return gets_out(thoughts.moment(), known["CAV1"], known[other[0]], first)


# Another vehicle stands where one that goes north comes past, but just so; or where it does not.
CORNER, MIDDLE = ("north-east", 105.0), ("north-east", 108.0)


def test_of_two_who_stand_the_one_that_goes_first_starts(junction: Junction, steady: Junction) -> None:
    assert passes(steady, 0.0, True, ("CAV2", *CORNER))
    assert not passes(steady, 60.0, False, ("CAV2", *CORNER))
    assert not passes(steady, 1.5, True, ("HDV1", *CORNER)), "it may have the right of way"
    assert passes(steady, 2.0, False, ("HDV1", *CORNER)), "it gives way"
    assert not passes(steady, 60.0, True, ("HDV1", *MIDDLE)), "its body is in the way"
    assert not passes(steady, 60.0, True, ("HDV1", *CORNER), 100.0), "the CAV is not in the junction"
    assert not passes(junction, 60.0, True, ("HDV1", *CORNER))


@pytest.mark.parametrize("method", [codriving, fcfs])
def test_a_cav_gets_out_past_a_driver_who_stands(
    method: Callable[[], Method], junction: Junction, steady: Junction
) -> None:
    human = Start("HDV1", Kind.HDV, "north-east", 105.0, 0.0, stands=600.0)
    starts = (Start("CAV1", Kind.CAV, "south-north", 105.0, 0.0), human)
    stuck, out = (drive(world.drive(*starts), method(), 0) for world in (junction, steady))
    assert stuck.outcome is not None
    assert out.outcome is not None
    assert (stuck.outcome.ending, out.outcome.ending) == (Ending.TIMEOUT, Ending.SUCCESS)


@pytest.mark.parametrize("method", [codriving, fcfs])
def test_a_cav_drives_up_behind_who_stands(method: Callable[[], Method], junction: Junction, steady: Junction) -> None:
    """Without its setting codriving stays in the junction for ever: it plans to start just before the horizon."""
    starts = (
        Start("CAV1", Kind.CAV, "south-north", 112.0, 0.0),
        Start("HDV1", Kind.HDV, "south-north", 134.0, 0.0, stands=600.0),
    )
    driven = drive(steady.drive(*starts), method(), 0, 30)
    assert 124.0 < farthest(steady, driven, "CAV1", 15.0) < 128.5
    if method is codriving:
        stuck = drive(junction.drive(*starts), method(), 0, 30)
        assert farthest(junction, stuck, "CAV1", 15.0) < BOX[1]
