"""A training that takes a second."""

from typing import Any

from codriving.config.build import build
from codriving.config.training import compose_training
from codriving.training.settings import MadqnSettings

TINY = (
    "decisions=160",
    "hidden=[8]",
    "warm_up=20",
    "batch=8",
    "every=2",
    "capacity=90",
    "exploration.over=100",
    "exam_every=60",
    "finalists=2",
    "final_episodes=1",
)


def tiny_config(*overrides: str) -> dict[str, Any]:
    """The config of junctions with one kind of traffic, short episodes and one exam of one episode."""
    config = compose_training("madqn_junction", (*TINY, *overrides), smoke=False)
    config["traffic"] = [
        {**config["traffic"][0], "cavs": [2, 3], "hdvs": [0, 1], "settings": {"time_limit": 5.0, "start": [50.0, 75.0]}}
    ]
    config["exams"] = [{**config["exams"][0], "cavs": 2, "episodes": 1, "settings": {"time_limit": 4.0}}]
    return config


def tiny(*overrides: str) -> MadqnSettings:
    """Its settings."""
    made = build(tiny_config(*overrides), object, "train")
    assert isinstance(made, MadqnSettings)
    return made
