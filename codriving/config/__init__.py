"""Overrides -> one checked config -> objects. The only room that imports Hydra and OmegaConf."""

from codriving.config.build import TARGET, asks_for, build, targets, validate
from codriving.config.choices import (
    ABLATION,
    ALL,
    CONTROLS,
    EXPERIMENTS,
    LISTED,
    STRESS,
    SUITE,
    SWEPT,
    TABLES,
    TRAININGS,
    check_config_dir,
    choices,
    config_folder,
    default_choice,
    describe,
    styles,
    taking_part,
    target_of,
    values,
)
from codriving.config.compose import compose, compose_named, show
from codriving.config.experiments import (
    ALL_OF_PAPER,
    ExperimentFile,
    built_in,
    experiment_file,
    experiment_names,
    key_of,
)
from codriving.config.given import Given
from codriving.config.locate import conf_dir, experiments_dir
from codriving.config.overrides import check_choice, parse, written
from codriving.config.plugins import PLUGINS
from codriving.config.schema import GROUPS, LARGEST_SEED, ROOT, looks_secret
from codriving.config.stress import stress_axis
from codriving.config.suites import changed_worlds, members, sets_scenario, suite_sets
from codriving.config.sweep import Point, expand
from codriving.config.target import find_class
from codriving.config.training import compose_training, trainings

__all__ = [
    "ABLATION",
    "ALL",
    "ALL_OF_PAPER",
    "CONTROLS",
    "EXPERIMENTS",
    "GROUPS",
    "LARGEST_SEED",
    "LISTED",
    "PLUGINS",
    "ROOT",
    "STRESS",
    "SUITE",
    "SWEPT",
    "TABLES",
    "TARGET",
    "TRAININGS",
    "ExperimentFile",
    "Given",
    "Point",
    "asks_for",
    "build",
    "built_in",
    "changed_worlds",
    "check_choice",
    "check_config_dir",
    "choices",
    "compose",
    "compose_named",
    "compose_training",
    "conf_dir",
    "config_folder",
    "default_choice",
    "describe",
    "expand",
    "experiment_file",
    "experiment_names",
    "experiments_dir",
    "find_class",
    "key_of",
    "looks_secret",
    "members",
    "parse",
    "sets_scenario",
    "show",
    "stress_axis",
    "styles",
    "suite_sets",
    "taking_part",
    "target_of",
    "targets",
    "trainings",
    "validate",
    "values",
    "written",
]  # fmt: skip
