"""One negotiation and one decision by a language model on a stored scene: ``codriving check``."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from codriving.config.build import build
from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.config.validate import validate
from codriving.errors import ConfigError, ModelError, ModelUnavailableError
from codriving.experiment.asking import REPLAY, model_of
from codriving.experiment.checked import verdict
from codriving.experiment.nodes import holds, replaced
from codriving.experiment.objects import BuildObjects

SEED, STEP = 10_001, 4
"""The scene: four CAVs and three human drivers before an intersection, most of them in conflict."""

_RULES = {"_target_": "codriving.llm.language_model.Offline"}
_PROBE = "codriving.methods.probe.Probe"


def run_check(overrides: Sequence[str], config_dir: Path | None = None) -> int:
    """Ask a model once for an order and once for a decision, and print what came back: ``codriving check``.

    The scene is driven to by the rules, so that it is always the same. Nothing is taken from the answer cache or put
    into it, unless ``llm.cache=replay`` is asked for.

    Args:
        overrides: ``key=value`` tokens.

    Returns:
        Exit code: 0 if both were answered in form or no model reasons, 1 if a fallback was needed.

    Raises:
        ConfigError: If the config cannot be used, or its method asks no model.
        ModelError: If the model cannot be reached.
    """
    resolved = compose(overrides, config_dir)
    validate(resolved)
    if not holds(resolved["method"], resolved["llm"]):
        raise ConfigError("this method asks no language model; leave method= out, or choose method=codriving")
    if model_of(resolved) is None:
        others = ", ".join(name for name in choices("llm", config_dir) if name != "offline")
        print("No model is asked: with this llm the built-in rules reason, without network and key.")
        print(f"Models: {others or 'none'}. Check one with: codriving check llm=NAME")
        return 0
    asked = _settings(resolved)
    model = model_of(asked)
    client = model.chat() if model is not None else None
    assert model is not None
    assert client is not None
    try:
        client.preflight()
        time, deliberation = _ask(asked)
    except ModelUnavailableError as error:
        raise ModelError(str(error)) from error
    print(f"{model.name} on {_scenario(asked)}, seed {SEED}, after {time:g} s\n")
    code, lines = verdict(deliberation.transcript)
    print("\n".join(lines))
    return code


def _scenario(resolved: Mapping[str, Any]) -> str:
    return str(build(resolved["scenario"], resolved["plugins"], "scenario").name)


def _settings(resolved: Mapping[str, Any]) -> dict[str, Any]:
    """The config of the check: the model itself has to answer, and it is to be asked in any case."""
    llm = dict(resolved["llm"])
    if llm.get("cache") not in (None, REPLAY):
        llm["cache"] = "off"
    if "ask_plain" in llm:
        llm["ask_plain"] = True
    return {**resolved, "llm": llm, "method": replaced(resolved["method"], resolved["llm"], llm)}


def _ask(resolved: Mapping[str, Any]) -> tuple[float, Any]:
    """Drive to the scene by the rules, then ask the model; gives the simulated time and what was deliberated."""
    rules = {**resolved, "method": replaced(resolved["method"], resolved["llm"], _RULES)}
    environment, driver, _ = BuildObjects({"check": rules})("check")
    world = environment.reset(SEED)
    driver.reset(environment.road_map, environment.driving_model, SEED)
    while environment.outcome is None:
        moment = driver.act(world)
        if world.step >= STEP and _is_open(moment.as_dict()):
            break
        world = environment.step(moment.actions)
    probe = build({"_target_": _PROBE, "method": resolved["method"]}, resolved["plugins"], "method")
    return world.time, probe.act(environment.road_map, environment.driving_model, SEED, world)


def _is_open(line: Mapping[str, Any]) -> bool:
    """Whether two CAVs have to agree on who goes first."""
    cavs = line.get("cavs", [])
    names = {cav["id"] for cav in cavs}
    return any({p["first"], p["second"]} <= names for cav in cavs for p in cav["order"]["precedences"])
