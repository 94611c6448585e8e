"""Where a vehicle may be of which one has heard: bounds that hold what was driven, and a check that minds them."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Junction, car, order_of

from codriving.config.compose import compose
from codriving.datatypes.world import Action, Told, WorldState
from codriving.environment.environment import Environment
from codriving.experiment.objects import make_objects
from codriving.reasoning.safety.conflict_lane import check_conflicts
from codriving.v2x.knowledge import KnownWorld

DRIVEN = {
    "turns and curves": "scenario=roundabout",
    "turns without limits": "scenario=intersection limits=none drivers=simulator",
    "noise in turns": "scenario=intersection v2x.noise=1 v2x.speed_noise=0.3",
    "lane changes": "scenario=merge",
    "high speeds": "scenario=highway v2x.age=0.5",
}
"""Episodes in which CAVs hear more than they see: each drives what its noise and the road make it do."""

HEARD = "v2x=good v2x.age=1 v2x.noise=0 v2x.speed_noise=0 scenario.detection_range=12 scenario.time_limit=14"


@dataclass(frozen=True)
class Claim:
    """What one CAV took a vehicle to do, and what that really did."""

    told: Told
    ahead: float  # How far ahead of where it was taken to be it was [m]
    faster: float  # [m/s]
    human: bool


def claims(typed: str) -> Iterator[Claim]:
    """Drive an episode and compare all that was believed with what was driven."""
    made = make_objects(compose([*HEARD.split(), *typed.split(), "method=madqn"]))
    environment, method = made.environment, made.method
    assert isinstance(environment, Environment)
    views: list[tuple[WorldState, WorldState]] = []

    def of(self: KnownWorld, world: WorldState) -> WorldState:
        views.append((world, known := looked(self, world)))
        return known

    looked = KnownWorld.of
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(KnownWorld, "of", of)
        environment.observer = method.observer
        world = environment.reset(20_011)
        method.reset(environment.road_map, environment.driving_model, 20_011)
        while environment.outcome is None:
            world = environment.step(method.act(world).actions)
    routes = {track.id: track.route for track in environment.trajectory().tracks}
    road_map = environment.road_map
    for world, known in views:
        true, taken = ({v.id: v for v in one.vehicles} for one in (world, known))
        for name, told in known.told.items():
            if told.seen or name not in true:
                continue
            there, here = true[name], taken[name]
            if told.since is None:
                route = known.intents[name].route
                expected = road_map.project(route, here.x, here.y)[0]
            else:
                route = routes[name]
                expected = road_map.project(route, *told.since[:2])[0] + here.speed * told.age
            place = road_map.project(route, there.x, there.y)[0]
            yield Claim(told, place - expected, there.speed - here.speed, told.since is not None)


@pytest.fixture(scope="module")
def driven() -> dict[str, list[Claim]]:
    """All claims of the episodes."""
    return {name: list(claims(typed)) for name, typed in DRIVEN.items()}


@pytest.mark.parametrize("name", DRIVEN)
def test_what_was_driven_since_is_within_the_bounds(name: str, driven: dict[str, list[Claim]]) -> None:
    found = driven[name]
    assert len(found) > 60
    for claim in found:
        told = claim.told
        assert -told.behind - 1e-6 <= claim.ahead <= told.ahead + 1e-6, claim
        assert -told.slower - 1e-6 <= claim.faster <= told.faster + 1e-6, claim


def test_the_bounds_are_needed(driven: dict[str, list[Claim]]) -> None:
    """What is taken for granted at a steady speed is wrong by metres, of CAVs and of human drivers."""
    every = [claim for found in driven.values() for claim in found]
    assert max(c.ahead for c in every) > 1.0
    assert min(c.ahead for c in every) < -2.0
    assert {c.human for c in every if abs(c.ahead) > 0.5} == {True, False}


OLD = Told(1.0, None, behind=3.4, ahead=1.2, slower=6.0, faster=1.5)


def removed(junction: Junction, mine: float, theirs: float, speed: float, told: Told | None) -> set[Action]:
    """What the third layer removes for CAV1, where a human driver comes from the west, seen or heard of."""
    world = junction.world(car("CAV1", "south-north", mine, 6.0), car("HDV1", "west-east", theirs, speed))
    if told is not None:
        world = replace(world, viewer="CAV1", told={"HDV1": told})
    return set(check_conflicts(junction.think(world).safety_input("CAV1", order_of("HDV1 CAV1"))))


@settings(max_examples=25)
@given(st.floats(90.0, 103.0), st.floats(60.0, 112.0), st.floats(0.0, 9.0))
def test_what_is_old_never_allows_more(junction: Junction, mine: float, theirs: float, speed: float) -> None:
    exact = removed(junction, mine, theirs, speed, None)
    assert exact <= removed(junction, mine, theirs, speed, OLD)
    assert exact == removed(junction, mine, theirs, speed, Told(0.0, None))
    # What its own sensors see is exact, however old the intent is.
    assert exact == removed(junction, mine, theirs, speed, replace(OLD, seen=True))


def test_an_action_that_is_safe_by_what_is_exact_is_removed_by_what_is_old(junction: Junction) -> None:
    # The human driver is 17 m before the crossing at 5 m/s; CAV1 passes it first, if that is so.
    assert removed(junction, 96.0, 87.0, 5.0, None) == set()
    assert removed(junction, 96.0, 87.0, 5.0, OLD) == {Action.FASTER, Action.IDLE}
    # A little noise alone removes less.
    assert removed(junction, 96.0, 87.0, 5.0, Told(0.0, None, behind=0.5, ahead=0.5)) == {Action.FASTER}
    assert removed(junction, 96.0, 84.0, 5.0, OLD) == {Action.FASTER}
