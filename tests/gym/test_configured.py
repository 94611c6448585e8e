"""Settings by keyword and override, and one line for each mistake."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import codriving
from codriving.errors import ConfigError
from codriving.gym.parallel import ParallelDriving


def test_keywords_are_keys_of_the_scenario() -> None:
    env = codriving.parallel_env(
        "intersection", cavs=np.int64(6), hdvs=(0, 0), time_limit=30, target_speeds=[0.0, 5.0, 10.0]
    )
    assert len(env.possible_agents) == 6
    env.reset(seed=0)
    assert env.world.hdvs == ()
    assert env.environment.driving_model.target_speeds == (0.0, 5.0, 10.0)


def test_overrides_reach_scenario_and_environment() -> None:
    env = codriving.parallel_env("intersection", "scenario.cavs=5", "drivers=simulator", "drivers.headway=1.2")
    assert len(env.possible_agents) == 5
    assert env.environment.drivers.headway == 1.2


def test_a_keyword_wins_over_an_override() -> None:
    assert len(codriving.parallel_env("intersection", "scenario.cavs=5", cavs=3).possible_agents) == 3


def test_toggles_of_the_level_are_overrides() -> None:
    env = codriving.parallel_env("intersection", "cda.intent_sharing=false", "cda.negotiation=false")
    other = codriving.parallel_env("intersection", cda="status_sharing")
    for one in (env, other):
        assert not one.reset(seed=1)[0]["CAV1"][1:, 5].any()
    full = codriving.parallel_env("intersection").reset(seed=1)[0]["CAV1"]
    assert full[1:, 5].any()


@pytest.mark.parametrize(
    ("name", "overrides", "settings", "said"),
    [
        ("intersecton", (), {}, "unknown scenario 'intersecton'; choices: intersection"),
        ("all", (), {}, "unknown scenario 'all'"),
        ("intersection", (), {"cda": "ful"}, "unknown cda 'ful'; choices: .*status_sharing"),
        ("intersection", (), {"cavs": 99}, "scenario.cavs must be 2 to 12, got 99"),
        ("intersection", (), {"cavs": "4"}, "scenario.cavs must be a whole number, got '4'"),
        ("intersection", (), {"cvas": 4}, "unknown key scenario.cvas; did you mean scenario.cavs"),
        ("intersection", (), {"cavs": {4}}, r"scenario.cavs must be a number, a text, a list, .* got \{4\}"),
        ("intersection", (), {"render_mode": "human"}, "render_mode must be rgb_array or None, got 'human'"),
        ("intersection", (), {"rows": 0}, "rows must be"),
        ("intersection", (), {"reward": {"speeed": 1}}, "unknown weight reward.speeed"),
        ("mine", (), {"config_dir": "/no/such/folder"}, "/no/such/folder is not a folder"),
        ("intersection", ("episodes=5",), {}, "'episodes=5' has no effect on an environment; keys with one begin with"),
        ("intersection", ("method.margin=1",), {}, "has no effect"),
        ("intersection", ("scenario=merge",), {}, "scenario is chosen by the first argument here"),
        ("intersection", ("+cda=full",), {}, "cda is chosen by cda='<preset>' here"),
        ("intersection", ("cavs",), {}, "has no effect"),
        ("intersection", ("scenario.cavs",), {}, "scenario.cavs stands alone; "),
        ("intersection", (4,), {}, "an override is a text such as .* got 4"),
        ("intersection", ("scenario.cavs=2,3",), {}, "scenario.cavs"),
    ],
)
def test_a_mistake_costs_one_line(name: str, overrides: Any, settings: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError, match=said) as caught:
        codriving.parallel_env(name, *overrides, **settings)
    assert "\n" not in str(caught.value)


@pytest.fixture
def own_configs(tmp_path: Path) -> Path:
    """A folder with a scenario of the user's: the intersection under another name, with longer legs."""
    from codriving.config.choices import choices

    text = choices("scenario")["intersection"].read_text().replace("leg_length: 100.0", "leg_length: 150.0")
    (tmp_path / "scenario").mkdir()
    (tmp_path / "scenario" / "mine.yaml").write_text(text)
    return tmp_path


def test_scenarios_of_the_user_are_environments_too(own_configs: Path) -> None:
    env = codriving.parallel_env("mine", config_dir=own_configs)
    assert isinstance(env, ParallelDriving)
    assert env.metadata["name"] == "codriving_mine_v1"
    assert env.observation_space("CAV1").high[0, 0] == pytest.approx(171)


def test_a_suite_of_flows_is_refused(own_configs: Path) -> None:
    (own_configs / "suite").mkdir()
    (own_configs / "suite" / "busy.yaml").write_text(
        "# @package _global_\n# A busy road.\ndefaults:\n  - override /flow: steady\n"
    )
    with pytest.raises(ConfigError, match="an environment drives episodes and no flows"):
        codriving.parallel_env("intersection", "suite=busy", config_dir=own_configs)


def test_agents_that_change_with_the_seed_are_refused(make_varying: Callable[[], ParallelDriving]) -> None:
    env = make_varying()
    env.reset(seed=2)
    with pytest.raises(ConfigError, match="must have the same CAVs for every seed"):
        env.reset(seed=3)


@pytest.fixture
def make_varying(monkeypatch: pytest.MonkeyPatch) -> Callable[[], ParallelDriving]:
    """An environment whose scenario has one CAV less for odd seeds."""
    from codriving.datatypes.world import Scene
    from codriving.environment.scenarios.intersection import Intersection

    draw = Intersection.scene

    def scene(self: Intersection, seed: int) -> Scene:
        whole = draw(self, seed)
        return Scene(seed, whole.starts[seed % 2 :])

    def make() -> ParallelDriving:
        monkeypatch.setattr(Intersection, "scene", scene)
        return codriving.parallel_env("intersection")

    return make
