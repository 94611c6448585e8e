"""Overrides and settings by keyword to an environment and a CDA level, by the same configs as `codriving run`."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from codriving.config import build, check_config_dir, choices, compose, config_folder
from codriving.datatypes import CaseMemory, Method, Model, RuleModel, Scenario
from codriving.environment import Environment
from codriving.errors import ConfigError
from codriving.reasoning import CdaLevel

# Keys of the root that make a difference here.
READ = ("scenario", "environment", "limits", "drivers", "suite", "cda", "plugins")

CHOSEN = ("scenario", "cda")  # Groups that are chosen by an argument, and not by an override


def configured(
    name: str, overrides: Sequence[str], cda: str, config_dir: str | Path | None, settings: Mapping[str, Any]
) -> tuple[Environment, CdaLevel]:
    """Build the environment of a scenario."""
    config = _composed({"scenario": name, "cda": cda}, overrides, config_dir, settings)
    if config["flow"] is not None:
        raise ConfigError("an environment drives episodes and no flows; take a suite that leaves flow alone")
    plugins = config["plugins"]
    build(config["scenario"], Scenario, "scenario", plugins)
    environment = build(config["environment"], Environment, "environment", plugins)
    return environment, build(config["cda"], CdaLevel, "cda", plugins)


def configured_method(
    name: str,
    overrides: Sequence[str],
    method: str,
    cda: str,
    config_dir: str | Path | None,
    settings: Mapping[str, Any],
) -> Method:
    """Build a method as it drives in the world of a scenario, by the built-in rules and without a memory."""
    config = _composed({"scenario": name, "cda": cda, "method": method}, overrides, config_dir, settings)
    return build(config["method"], Method, "method", config["plugins"], {Model: RuleModel(), CaseMemory: None})


def _composed(
    chosen: Mapping[str, str], overrides: Sequence[str], config_dir: str | Path | None, settings: Mapping[str, Any]
) -> dict[str, Any]:
    """Compose the config of an environment from a choice of some groups and keys of the scenario."""
    folder = config_folder(config_dir)
    if folder is not None:
        check_config_dir(folder)
    for group, choice in chosen.items():
        known = choices(group, folder)
        if not isinstance(choice, str) or choice not in known:
            raise ConfigError(f"unknown {group} {choice!r}; choices: {', '.join(known)}")
    for token in overrides:
        _check_read(token)
    tokens = [f"scenario.{key}={_written(f'scenario.{key}', value)}" for key, value in settings.items()]
    return compose([*(f"{group}={choice}" for group, choice in chosen.items()), *overrides, *tokens], folder)


def _check_read(token: str) -> None:
    """Refuse what would have no effect, such as a key that is not read here."""
    if not isinstance(token, str):
        raise ConfigError(f"an override is a text such as 'drivers=rough', got {token!r}")
    key = token.lstrip("+").partition("=")[0]
    if key in CHOSEN:
        way = "the first argument" if key == "scenario" else "cda='<preset>'"
        raise ConfigError(f"{token!r}: {key} is chosen by {way} here")
    if key.partition(".")[0] not in READ:
        raise ConfigError(f"{token!r} has no effect on an environment; keys with one begin with {', '.join(READ)}")


def _written(key: str, value: object) -> str:
    """Write a value in the grammar of overrides."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, bool):
        return json.dumps(value)
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, str):
        return "'" + value.replace("\\", "\\\\").replace("'", "\\'") + "'"
    if isinstance(value, list | tuple):
        return "[" + ",".join(_written(key, inner) for inner in value) + "]"
    raise ConfigError(f"{key} must be a number, a text, a list, True, False or None, got {value!r}")
