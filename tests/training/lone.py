"""Trainings of a single vehicle that take a few seconds."""

from typing import Any

from codriving.config.build import build
from codriving.config.training import compose_training
from codriving.training.settings import SingleSettings

TINY = (
    "decisions=96",
    "hidden=[8]",
    "rollout=16",
    "batch=16",
    "epochs=2",
    "exam_every=64",
    "finalists=2",
    "final_episodes=1",
)


def lone_config(learner: str, *overrides: str) -> dict[str, Any]:
    """The config of junctions with two environments and one exam of one short episode."""
    config = compose_training(f"{learner}_junction", (*TINY, *overrides), smoke=False)
    config["traffic"] = [
        {**config["traffic"][0], "cavs": 2, "hdvs": [0, 1], "copies": 2, "settings": {"time_limit": 8.0}}
    ]
    config["exams"] = [{**config["exams"][0], "cavs": 2, "episodes": 1, "settings": {"time_limit": 4.0}}]
    return config


def lone(learner: str, *overrides: str) -> SingleSettings:
    """Its settings."""
    made = build(lone_config(learner, *overrides), object, "train")
    assert isinstance(made, SingleSettings)
    return made
