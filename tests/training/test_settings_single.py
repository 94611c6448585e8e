"""The settings of trainings of a single vehicle: what is shipped can be built, and what is out of range is refused."""

import pytest

from codriving.config.build import build
from codriving.config.training import compose_training
from codriving.errors import ConfigError
from codriving.methods.learned.layout import FAMILIES
from codriving.training.settings import SingleSettings


@pytest.mark.parametrize("smoke", [False, True])
@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("learner", ["ppo", "tell"])
def test_shipped_trainings_can_be_built(learner: str, family: str, smoke: bool) -> None:
    made = build(compose_training(f"{learner}_{family}", (), smoke), object)
    assert isinstance(made, SingleSettings)
    assert (made.learner, made.family, made.shared) == (learner, family, False)
    assert (made.guidance is None) == (learner == "ppo")
    if smoke:
        assert made.decisions < 10_000


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("learner=sac", "learner must be one of ppo, tell"),
        ("family=rivers", "family must be one of"),
        ("form=tree", "form must be one of"),
        ("rollout=1", "rollout must be 2 or more"),
        ("exam_seed=5", "exam_seed must be 10000 or more"),
        ("hidden=[]", "hidden must name"),
        ("discount=1.0", "discount must be"),
        ("trace=1.5", "trace must be"),
        ("entropy=0.0", "entropy must be positive"),
        ("traffic=[]", "traffic and exams"),
        ("reward.luck=1", "reward.luck"),
    ],
)
def test_settings_out_of_range_are_refused(override: str, words: str) -> None:
    key, _, _ = override.partition("=")
    config = compose_training("ppo_junction", (() if key == "traffic" else (override,)), smoke=False)
    if key == "traffic":
        config["traffic"] = []
    with pytest.raises(ConfigError, match=words):
        build(config, object)


def test_no_copies_are_no_traffic() -> None:
    config = compose_training("ppo_junction", ("traffic.0.copies=0",), smoke=False)
    with pytest.raises(ConfigError, match="copies must be 1 or more"):
        build(config, object)
