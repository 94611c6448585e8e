"""Drivers are drawn from the seed and their names; what a mix may hold; styles are noted, and no method sees them."""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import pytest

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.parts import CaseMemory, Drivers, Method, Model, RuleModel
from codriving.environment.drivers.style import DriverMix, DriverTraits
from codriving.environment.environment import Environment
from codriving.errors import ConfigError

NAMES = [f"HDV{k}" for k in range(1, 301)]


def mix(*overrides: str) -> DriverMix:
    made = build(compose(overrides)["drivers"], Drivers, "drivers")
    assert isinstance(made, DriverMix)
    return made


def drawn(env: Environment, seed: int) -> dict[str, DriverTraits]:
    env.reset(seed)
    return {v.id: v.traits for v in env._traffic.vehicles if v.id.startswith("HDV")}


@pytest.mark.parametrize(
    ("name", "shares"),
    [
        ("attentive", {"attentive": 1.0}),
        ("mixed", {"attentive": 0.5, "aggressive": 0.2, "hesitant": 0.1, "nonyielding": 0.1, "distracted": 0.1}),
        ("rough", {"attentive": 0.3, "aggressive": 0.25, "hesitant": 0.1, "nonyielding": 0.2, "distracted": 0.15}),
    ],
)
def test_styles_come_in_their_shares(name: str, shares: dict[str, float]) -> None:
    found = mix(f"drivers={name}")
    drivers = [found.draw(seed, one) for seed in range(10) for one in NAMES]
    counts = Counter(driver.style for driver in drivers)
    for style, share in shares.items():
        assert counts[style] / 3000 == pytest.approx(share, abs=0.03)
    assert sum(driver.signals for driver in drivers) / 3000 == pytest.approx(0.75, abs=0.03)
    kept = [driver.reaction for driver in drivers]
    assert 0.5 <= min(kept) < 0.52
    assert 1.08 < max(kept) <= 1.1


def test_no_driver_keeps_less_distance_than_it_drives_until_it_reacts() -> None:
    made = mix("drivers=rough")
    drivers = [made.draw(0, name) for name in NAMES]
    assert all(driver.profile.headway >= driver.reaction for driver in drivers)
    assert min(driver.profile.headway for driver in drivers if driver.style == "aggressive") < 0.7


def test_a_driver_is_told_by_seed_and_name() -> None:
    found = mix("drivers=mixed")
    assert found.draw(3, "HDV1") == found.draw(3, "HDV1")
    assert len({found.draw(seed, name).reaction for seed in range(20) for name in ("HDV1", "HDV2", "HDV11")}) == 60


def test_one_more_driver_changes_no_other(configured: Callable[..., Environment]) -> None:
    few, many = (
        drawn(configured("drivers=rough", f"scenario.hdvs=[{n},{n}]", f"scenario.cavs={c}"), 10_000)
        for n, c in ((3, 4), (5, 2))
    )
    assert len(few) == 3
    assert few.items() <= many.items()


def test_another_share_changes_only_whom_it_concerns() -> None:
    before, after = mix("drivers=mixed"), mix("drivers=mixed", "drivers.shares.distracted=0")
    pairs = [(before.draw(0, name), after.draw(0, name)) for name in NAMES]
    same = [(one, other) for one, other in pairs if one.style == other.style]
    assert len(same) > 150
    assert all(one == other for one, other in same)
    assert {one.style for one, other in pairs if one.style != other.style} >= {"distracted"}
    # What does not depend on the style is the same for all.
    assert all((one.signals, one.exponent) == (other.signals, other.exponent) for one, other in pairs)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("drivers.shares.polite=0.5", "drivers.shares.polite is of no style; styles: attentive, aggressive"),
        ("drivers.shares.attentive=-1", "drivers.shares.attentive must be 0 to 1, got -1"),
        ("drivers.signals=2", "drivers.signals must be 0 to 1, got 2"),
        ("drivers.styles.hesitant.headway=[3,1]", r"drivers.styles.hesitant.headway must be \[smallest, largest\]"),
        ("drivers.styles.hesitant.horizon=9", "drivers.styles.hesitant.horizon must be 0.25 to 6 s, got 9"),
        ("drivers.styles.hesitant.gives_way=always", "gives_way must be one of by_rule, to_higher_rank, never"),
        ("drivers.jam_distance=2", "drivers.jam_distance must be 5.5 to 30, got 2"),
    ],
)
def test_what_a_mix_cannot_be_is_refused(override: str, message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        mix("drivers=mixed", override)


def test_a_mix_of_none_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"drivers\.shares must have one above 0, got none; set for instance drivers"):
        mix("drivers=attentive", "drivers.shares.attentive=0")


def test_styles_are_noted_of_every_human_driver(configured: Callable[..., Environment]) -> None:
    env = configured("drivers=rough", "scenario.hdvs=[4,4]")
    traits = drawn(env, 10_000)
    noted = {track.id: track.style for track in env.trajectory().tracks}
    assert {name: style for name, style in noted.items() if style} == {name: t.style for name, t in traits.items()}
    plain = configured("drivers=simulator")
    plain.reset(10_000)
    assert {track.style for track in plain.trajectory().tracks} == {""}


@pytest.mark.parametrize("name", ["codriving", "fcfs", "pidm", "noncoop_game"])
def test_no_method_sees_a_style(name: str, configured: Callable[..., Environment]) -> None:
    resolved = compose(["drivers=rough", f"method={name}", "scenario.hdvs=[4,4]"])
    decided = []
    for poisoned in (False, True):
        env = configured("drivers=rough", "scenario.hdvs=[4,4]")
        method = build(resolved["method"], Method, "method", given={Model: RuleModel(), CaseMemory: None})
        world = env.reset(10_001)
        method.reset(env.road_map, env.driving_model, 10_001)
        actions = []
        for _ in range(6):
            if poisoned:
                for vehicle in env._traffic.vehicles:
                    if vehicle.id.startswith("HDV"):
                        vehicle.style = "poison"
                        vehicle.traits = replace(vehicle.traits, style="poison")
                world = env._look()
            assert "style" not in repr(world)
            assert "poison" not in repr(world)
            actions.append(method.act(world).actions)
            world = env.step(actions[-1])
        decided.append(actions)
    assert decided[0] == decided[1]


def test_bounds_on_what_drivers_do_are_those_of_the_mix(configured: Callable[..., Environment]) -> None:
    def bounds(*overrides: str) -> tuple[float, float]:
        model = configured(*overrides).driving_model
        return model.human_braking, model.human_acceleration

    assert bounds("drivers=simulator") == (6.0, 1.5)
    assert bounds("drivers=attentive") == (6.0, 2.6)
    assert bounds("drivers=rough") == (6.0, 3.0)
    assert bounds("drivers=rough", "drivers.shares.aggressive=0", "drivers.limit=7") == (7.0, 2.6)


def test_signals_are_seen_and_the_simulators_drivers_show_none(configured: Callable[..., Environment]) -> None:
    for drivers, most in (("simulator", 0), ("attentive", 99)):
        env, shown = configured(f"drivers={drivers}"), set()
        for seed in range(10_000, 10_004):
            world = env.reset(seed)
            while env.outcome is None and world.time < 10.0:
                shown |= set(world.signals.values())
                world = env.step(dict.fromkeys(world.available, "IDLE"))
        assert shown == ({"left", "right"} if most else set())
