"""The configs of trainings: every shipped one builds, and mistakes are refused with their key."""

import inspect
import re
from pathlib import Path

import pytest

from codriving.config.build import build
from codriving.config.training import compose_training, trainings
from codriving.environment.environment import Environment
from codriving.errors import ConfigError
from codriving.gym.parallel import ParallelDriving
from codriving.gym.single import SingleDriving
from codriving.training.advised_observer import AdvisedObserver
from codriving.training.curriculum import shares, world_of
from codriving.training.settings import MadqnSettings, SingleSettings

MADQN = [name for name in trainings() if name.startswith("madqn")]


def made(*overrides: str, name: str = "madqn_junction", smoke: bool = False) -> MadqnSettings:
    settings = build(compose_training(name, overrides, smoke), object, "train")
    assert isinstance(settings, MadqnSettings)
    return settings


@pytest.mark.parametrize("name", MADQN)
@pytest.mark.parametrize("smoke", [False, True])
def test_every_training_builds_and_shows_all_of_its_settings(name: str, smoke: bool) -> None:
    config = compose_training(name, (), smoke)
    settings = made(name=name, smoke=smoke)
    assert set(inspect.signature(MadqnSettings).parameters) == set(config) - {"_target_"}
    assert name == f"madqn_{settings.family}"
    assert len(settings.exams) * 1000 < 100_000
    assert all(exam.episodes <= 1000 for exam in settings.exams)


@pytest.mark.parametrize(
    ("world", "limits"),
    [(("world.suite=paper",), False), (("world.suite=default",), True), (("world.limits=road",), True)],
)
def test_all_of_a_training_drives_in_its_world(world: tuple[str, ...], limits: bool) -> None:
    together = made(*world)
    alone = build(compose_training("ppo_junction", world, smoke=True), SingleSettings, "train")

    def observer(environment: Environment) -> AdvisedObserver:
        return AdvisedObserver(environment.road_map, environment.driving_model, "junction", None)

    environments: list[ParallelDriving | SingleDriving] = [
        *together.traffic[0].environments(together.weights),
        *(exam.environment for exam in (*together.exams, *alone.exams)),
        *(kind.environment(observer, "junction", alone.weights) for kind in alone.traffic),
    ]
    assert len(environments) > 5
    assert {each.environment.limits is not None for each in environments} == {limits}


def test_world_of_a_training_is_named_by_its_limits_and_drivers() -> None:
    assert world_of(made().world) == {"limits": "road", "drivers": "mixed"}
    assert world_of({"suite": "paper"}) == {"limits": "none", "drivers": "simulator"}
    assert world_of({"drivers": "rough"}) == {"limits": "road", "drivers": "rough"}


def test_a_config_of_release_0_1_trains_in_the_world_of_then() -> None:
    config = compose_training("ppo_junction", (), smoke=True)
    del config["world"]
    assert build(config, SingleSettings, "train").world == {"suite": "paper"}


def test_a_suite_of_the_user_is_refused_before_anything_is_built(tmp_path: Path) -> None:
    (tmp_path / "suite").mkdir()
    (tmp_path / "suite" / "mine.yaml").write_text("# @package _global_\n# Mine.\n")
    with pytest.raises(ConfigError, match="unknown suite 'mine'; choices: default, paper"):
        compose_training("ppo_junction", ["world.suite=mine"], False, tmp_path)


def test_smoke_changes_what_it_says_and_nothing_else() -> None:
    assert made(smoke=True).decisions == 20_000
    assert made(smoke=True).exploration.over == 8_000
    assert made(smoke=True).hidden == made().hidden


def test_overrides_reach_into_lists() -> None:
    settings = made("traffic.0.weight=7", "exams.1.episodes=3", "rate.start=0.01", "traffic.0.settings.leg_length=80")
    assert settings.traffic[0].weight == 7
    assert settings.exams[1].episodes == 3
    assert settings.rate.start == 0.01
    assert settings.traffic[0].settings["leg_length"] == 80


@pytest.mark.parametrize(
    ("token", "words"),
    [
        ("sed=2", "unknown key sed; did you mean seed?"),
        ("traffic.9.weight=1", "unknown key traffic.9.weight"),
        ("rate.strat=1", "unknown key rate.strat"),
        ("seed.low=1", "unknown key seed.low"),
        ("seed=1,2", "one value"),
        ("~seed", "one value"),
        ("decisions=many", "train.decisions must be a whole number"),
        ("decisions=0", "train.decisions must be 1 or more"),
        ("exam_seed=5", "train.exam_seed must be 10000 or more"),
        ("discount=1", "train.discount must be"),
        ("average=0", "train.average must be"),
        ("clip=0", "clip and faster must be positive"),
        ("hidden=[]", "train.hidden must name"),
        ("family=rivers", "train.family must be one of"),
        ("exploration.end=2", "exploration.end must be 0 to 1"),
        ("rate.over=0", "over must be 1 or more"),
        ("traffic.0.cavs=[4,2]", "cavs must be smallest and largest"),
        ("traffic.0.since=2", "since must be 0 to 1"),
        ("traffic.0.weight=-1", "weight must be 0 or more"),
        ("exams=[]", "exams at least one"),
        ("exams.0.episodes=0", "episodes must be 1 or more"),
        ("reward.arival=1", "unknown weight reward.arival"),
    ],
)
def test_mistakes_are_refused(token: str, words: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(words)):
        made(token)


def test_a_config_of_ones_own_is_read_as_every_other(tmp_path: Path) -> None:
    (tmp_path / "train").mkdir()
    file = tmp_path / "train" / "madqn_junction.yaml"
    text = trainings()["madqn_junction"].read_text(encoding="utf-8")
    file.write_text(text.replace("clip: 10.0", "clip: ${batch}"))
    assert compose_training("madqn_junction", (), False, tmp_path)["clip"] == 256
    file.write_text(text.replace("clip: 10.0", "clip: ${oc.env:HOME}"))
    with pytest.raises(ConfigError, match=r"madqn_junction\.yaml: clip reads an environment variable"):
        compose_training("madqn_junction", (), False, tmp_path)
    file.write_text(text.replace("clip: 10.0", "clip: ${bath}"))
    with pytest.raises(ConfigError, match=r"^cannot read .* \(Interpolation key 'bath' not found\)$"):
        compose_training("madqn_junction", (), False, tmp_path)


def test_an_unknown_training_is_refused() -> None:
    with pytest.raises(ConfigError, match="there is no training 'rivers'"):
        compose_training("rivers", (), False)


def test_traffic_comes_in_when_its_time_has_come() -> None:
    kinds = made(*(f"traffic.{k}.weight={weight}" for k, weight in enumerate((1, 1, 2, 4, 1, 7)))).traffic
    assert shares(kinds, 0.0) == [0.2, 0.2, 0.4, 0.0, 0.2, 0.0]
    assert shares(kinds, 0.4) == [1 / 12, 1 / 12, 2 / 12, 0.0, 1 / 12, 7 / 12]
    assert shares(kinds, 0.5) == [1 / 16, 1 / 16, 2 / 16, 4 / 16, 1 / 16, 7 / 16]
