"""CAVs that are handed over drive as attentive drivers, and change neither the scene nor the human drivers."""

from collections.abc import Callable

import pytest

from codriving.datatypes.world import Action, Kind
from codriving.environment.environment import Environment
from codriving.environment.traffic.human_driver import HumanDriver
from codriving.environment.traffic.unguided import UnguidedVehicle
from codriving.errors import EpisodeError

Made = Callable[..., Environment]

SETTINGS = ("limits=road", "drivers=rough", "scenario.hdvs=[4,4]")


def humans(environment: Environment) -> list[tuple[object, ...]]:
    """Return where the human drivers are and what was drawn for them."""
    found = [v for v in environment._traffic.vehicles if v.kind is Kind.HDV]
    assert all(isinstance(v, HumanDriver) for v in found)
    return [(v.id, *v.position.tolist(), v.speed, v.DELTA, v.target_speed, v.traits) for v in found]


@pytest.mark.parametrize("settings", [SETTINGS, ("scenario.hdvs=[4,4]",)], ids=["rough", "simulator"])
def test_scene_and_human_drivers_are_those_of_every_method(settings: tuple[str, ...], configured: Made) -> None:
    environment = configured("scenario=intersection", *settings)
    for seed in (10_000, 10_001):
        before = environment.reset(seed)
        drawn = humans(environment)
        state = environment._traffic.np_random.bit_generator.state
        handed = environment.hand_over()
        assert humans(environment) == drawn
        assert environment._traffic.np_random.bit_generator.state == state, "nothing was drawn"
        assert handed.vehicles == before.vehicles
        assert {name: intent.route for name, intent in handed.intents.items()} == {
            name: intent.route for name, intent in before.intents.items()
        }
        assert set(handed.available.values()) == {()}


def test_no_action_is_asked_for_and_none_is_taken(configured: Made) -> None:
    environment = configured("scenario=intersection", *SETTINGS)
    environment.reset(10_000)
    environment.hand_over()
    with pytest.raises(EpisodeError, match="one action for each of"):
        environment.step({"CAV1": Action.FASTER})
    environment.step({})
    with pytest.raises(EpisodeError, match="when an episode begins"):
        environment.hand_over()
    environment.reset(10_000)
    with pytest.raises(EpisodeError, match="one action for each of"):
        environment.step({})


def test_all_of_them_are_the_typical_attentive_driver_and_want_the_top_target(configured: Made) -> None:
    environment = configured("scenario=intersection", *SETTINGS)
    environment.reset(10_000)
    environment.hand_over()
    cavs = [v for v in environment._traffic.vehicles if v.kind is Kind.CAV]
    assert len(cavs) == 4
    for cav in cavs:
        assert isinstance(cav, UnguidedVehicle)
        assert (cav.traits.style, cav.traits.reaction, cav.traits.patience) == ("attentive", 0.8, 8.0)
        assert pytest.approx((1.4, 1.9, -2.9)) == (cav.TIME_WANTED, cav.COMFORT_ACC_MAX, cav.COMFORT_ACC_MIN)
        assert (cav.style, cav.signals, cav.target_speed) == ("", True, 9.0)
        cav.target_speed = 10.0
        assert cav.target_speed == 9.0, "after a wait it wants no more than other CAVs may drive"
        assert cav.limits is not None


def test_episode_ends_as_it_does_for_other_cavs(configured: Made) -> None:
    environment = configured("scenario=intersection", *SETTINGS)
    ends = []
    for _ in range(2):
        environment.reset(10_002)
        environment.hand_over()
        while environment.outcome is None:
            environment.step({})
        tracks = environment.trajectory().tracks
        ends.append((environment.outcome, [(t.id, t.kind, t.style, t.x[-1], t.y[-1]) for t in tracks]))
        assert all(not t.style and not any(t.action) for t in tracks if t.kind is Kind.CAV)
    assert ends[0] == ends[1]
    assert set(ends[0][0].arrivals) == {"CAV1", "CAV2", "CAV3", "CAV4"}


def test_what_hides_whom_is_told_of_the_vehicles_that_are_on_the_road(configured: Made) -> None:
    environment = configured("scenario=intersection", "scenario.blind=8", *SETTINGS)
    environment.reset(10_000)
    assert any(environment._traffic.hidden.values()), "some are hidden from one another"
    environment.hand_over()
    assert environment._traffic.hidden.keys() == set(environment._traffic.vehicles)


def test_a_cav_that_comes_in_with_a_flow_is_handed_over_too(configured: Made) -> None:
    environment = configured("scenario=intersection", "flow=steady", *SETTINGS[:2])
    environment.reset(10_000)
    environment.hand_over()
    for _ in range(30):
        world = environment.step({})
    assert len(world.cavs) >= 2
    assert set(world.available.values()) == {()}
    environment.reset(10_000)
    guided = environment.step(dict.fromkeys(environment._world.available, Action.IDLE))
    assert all(guided.available.values()), "the next episode begins with CAVs that take actions"
