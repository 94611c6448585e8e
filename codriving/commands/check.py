"""One negotiation and one decision by a language model on a stored scene: ``codriving check``."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from codriving.config import build, choices, compose, validate
from codriving.datatypes import Deliberation, Model, RuleModel, Scenario
from codriving.errors import ConfigError, ModelError, ModelUnavailableError
from codriving.experiment import REPLAY, announce, make_objects, model_of

SEED, STEP = 10_001, 4  # The scene: four CAVs and three human drivers before an intersection, most of them in conflict

LONGEST = 300  # Characters of an answer that are shown

_NAMES = {"negotiate": "Negotiation", "decide": "Decision"}


def run_check(overrides: Sequence[str], config_dir: Path | None = None) -> int:
    """Ask a model once for an order and once for a decision, and print what came back: ``codriving check``.

    The scene is driven to by the rules, so that it is always the same. Nothing is taken from the answer cache or put
    into it, unless ``llm.cache=replay`` is chosen.

    Args:
        overrides: ``key=value`` tokens.

    Returns:
        Exit code: 0 if both were answered whole and in form or no model reasons, 1 if not.

    Raises:
        ConfigError: If the config cannot be used, or its method asks no model.
        ModelError: If the model cannot be reached.
    """
    resolved = compose(overrides, config_dir)
    validate(resolved)
    resolved["llm"] = _settings(resolved["llm"])
    if (model := model_of(resolved)) is None:
        raise ConfigError("this method asks no language model; leave method= out, or choose method=codriving")
    if (client := model.chat()) is None:
        others = ", ".join(name for name in choices("llm", config_dir) if name != "offline")
        print("No model is asked: with this llm the built-in rules reason.")
        print(f"Models: {others or 'none'}\nCheck one with: codriving check llm=NAME")
        return 0
    client.on_retry = client.on_note = announce
    try:
        client.preflight()
        scene, deliberation = _ask(resolved, model)
    except ModelUnavailableError as error:
        raise ModelError(str(error)) from error
    served = f", which its server calls {client.served}," if client.served not in ("", model.name) else ""
    print(f"{model.name}{served} on {scene}\n")
    code, lines = report(deliberation.transcript, deliberation.counts)
    print("\n".join(lines))
    return code


def _settings(llm: Mapping[str, Any]) -> dict[str, Any]:
    """The model itself has to answer, and it is asked in any case."""
    changed = {"ask_plain": True} if llm.get("cache") == REPLAY else {"ask_plain": True, "cache": "off"}
    return {key: changed.get(key, value) for key, value in llm.items()}


def _ask(resolved: Mapping[str, Any], model: Model) -> tuple[str, Deliberation]:
    """Drive to the scene by the rules, then ask the model; gives the scene in words and what was asked and answered."""
    by_rules, asked = make_objects(resolved, RuleModel()), make_objects(resolved, model)
    environment, driver = by_rules.environment, by_rules.method
    world = environment.reset(SEED)
    driver.reset(environment.road_map, environment.driving_model, 0)
    while environment.outcome is None:
        deliberation = driver.act(world)
        if world.step >= STEP and _is_open(deliberation.as_dict()):
            break
        world = environment.step(deliberation.actions)
    asked.method.reset(environment.road_map, environment.driving_model, 0)
    scenario = build(resolved["scenario"], Scenario, "scenario", resolved["plugins"])
    return f"{scenario.name}, seed {SEED}, after {world.time:g} s", asked.method.ask_once(world)


def _is_open(line: Mapping[str, Any]) -> bool:
    """Whether two CAVs have to agree on a passing order."""
    cavs = line.get("cavs", [])
    names = {cav["id"] for cav in cavs}
    return any({p["first"], p["second"]} <= names for cav in cavs for p in cav["order"]["precedences"])


def report(transcript: Sequence[Mapping[str, Any]], counts: Mapping[str, float] = {}) -> tuple[int, list[str]]:
    """Say what was answered, and whether all of it could be used."""
    if not transcript:
        raise ModelError("the model was not asked anything in this scene; leave scenario= and cda= out")
    lines = [text for line in transcript for text in [*_answer(line), ""]]
    missing = [_NAMES.get(line["purpose"], line["purpose"]).lower() for line in transcript if line["value"] is None]
    if missing:
        return 1, [*lines, f"No usable answer for the {' and the '.join(missing)}: a fallback was needed."]
    if counts.get("repaired_orders"):
        return 1, [*lines, "The order leaves pairs out or goes in a circle: the rules had to complete it."]
    return 0, [*lines, "Answered in the form asked for."]


def _answer(line: Mapping[str, Any]) -> list[str]:
    calls = line["calls"]
    costs = [call["cost"] for call in calls]
    prompt, answer = (sum(call[name] for call in calls) for name in ("prompt_tokens", "completion_tokens"))
    shown = {
        "answer": "none that can be used" if line["value"] is None else _shown(json.dumps(line["value"])),
        "problem": _shown(line["problem"]),
        "said": _shown(calls[-1]["text"]) if line["value"] is None and calls else "",
        "form": calls[-1]["form"] if calls else "",
        "latency": f"{sum(call['seconds'] for call in calls):.2f} s",
        "tokens": f"{prompt} of the prompt, {answer} of the answer",
        "cost": "no price known" if None in costs else f"{sum(costs):.6f} USD",
        "re-asks": str(max(0, len(calls) - 1 - line["shortened"])),
    }
    subject = f" of {_shown(line['subject'])}" if line["subject"] else ""
    title = f"{_NAMES.get(line['purpose'], line['purpose'])}{subject}"
    return [title, *(f"  {name:<8} {text}" for name, text in shown.items() if text)]


def _shown(text: str) -> str:
    """A text on one line; what a terminal would take for a command is escaped."""
    plain = "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in " ".join(text.split()))
    return plain if len(plain) <= LONGEST else f"{plain[:LONGEST]}..."
