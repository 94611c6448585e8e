"""`codriving compare models`: one method with each language model, control and the rules in its place."""

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from codriving.config import Point, check_choice, choices, expand, parse, target_of, values
from codriving.errors import ConfigError
from codriving.experiment import (
    Cell,
    Driven,
    Outputs,
    Plan,
    model_of,
    refuse_flows,
    results_of,
)
from codriving.reports import CellResults, ModelRow, Repetition, markdown_text, model_rows, model_table, print_models
from codriving.runs import EPISODES, read_manifest, read_transcript

LLM, EPOCHS, EPOCH = "llm", "epochs", "epoch"

MOST = 100  # Times that each seed is driven at most

NO_MODELS = (
    "compare models needs the models to compare; write for instance codriving compare models llm=first,random,offline"
)

NO_FLOWS = (
    "codriving compare models pairs episodes, and in flows nothing is paired; write for instance codriving run "
    "llm=first,offline flow=steady"
)

CONTROLS_OF_MODELS = "codriving.llm.controls."  # Where the classes of controls in a model's place are

# Keys of ``llm`` that are about a server; controls and rules ask none.
OF_A_SERVER = (
    *("model", "model_prefix", "label", "api_base", "api_key_env", "api_key_header", "extra", "headers"),
    *("temperature", "max_tokens", "max_tokens_field", "system_role", "stream", "deadline", "attempts"),
    *("max_concurrency", "input_cost_per_token", "output_cost_per_token"),
)


def model_points(base: Sequence[str], overrides: Sequence[str], config_dir: Path | None) -> list[Point]:
    """Give the cells: each setting with each model that ``llm=`` names, as often as ``epochs=`` says.

    What is set below ``llm.`` holds for the models that have such a key.

    Args:
        base: Tokens that come first.
        overrides: What the user typed.
    """
    epochs, overrides = _epochs(overrides)
    keys = [parse(token).key_or_group for token in overrides]
    if epochs > 1 and f"{LLM}.{EPOCH}" in keys:
        raise ConfigError(f"{LLM}.{EPOCH} is what {EPOCHS}={epochs} varies; leave one of them out")
    named = [token for token, key in zip(overrides, keys, strict=True) if key == LLM]
    given = [point.overrides[0].partition("=")[2] for token in named for point in expand([token], config_dir)]
    names = [name for name in dict.fromkeys(given) if name]
    if not names:
        raise ConfigError(NO_MODELS)
    for name in names:
        check_choice(LLM, name, config_dir)
    known = {name: _keys(choices(LLM, config_dir)[name]) for name in names}
    anywhere = set().union(*known.values())
    found = []
    for point in expand([token for token in overrides if token not in named], config_dir):
        for name in names:
            kept = [t for t in point.overrides if (key := _setting(t)) not in anywhere or key in known[name]]
            for epoch in range(1, epochs + 1 if EPOCH in known[name] else 2):
                again = (f"{LLM}.{EPOCH}={epoch}",) if epoch > 1 else ()
                swept = {**point.swept, LLM: name}
                swept |= {f"{LLM}.{EPOCH}": str(epoch)} if epochs > 1 and EPOCH in known[name] else {}
                found.append(Point((*base, *kept, f"{LLM}={name}", *again), swept, point.removed))
    return found


def _epochs(overrides: Sequence[str]) -> tuple[int, list[str]]:
    """Take ``epochs=`` out of the tokens."""
    own = [token for token in overrides if token.lstrip("+").partition("=")[0] == EPOCHS]
    given = own[-1].partition("=")[2] if own else "1"
    if not (given.isascii() and given.isdigit() and 1 <= int(given[:9]) <= MOST):
        raise ConfigError(f"{EPOCHS} must be a whole number of 1 to {MOST}, got {given!r:.100}")
    return int(given), [token for token in overrides if token not in own]


def _setting(token: str) -> str:
    """Give the key below ``llm`` that a token sets; empty for any other token."""
    first, _, rest = token.lstrip("+").partition("=")[0].partition(".")
    return rest.partition(".")[0] if first == LLM else ""


def _keys(file: Path) -> set[str]:
    """Give the keys of a model that a command line may set."""
    control = (target_of(file) or "").startswith(CONTROLS_OF_MODELS)
    return set(values(file)).difference(OF_A_SERVER if control else ())


def check_models(plan: Plan) -> None:
    """Refuse what has no place for a model."""
    refuse_flows(NO_FLOWS, plan)
    for cell in plan.cells:
        if model_of(cell.resolved) is None:
            raise ConfigError(
                f"method={cell.labels.method} asks no language model; choose method=codriving or method=dilu"
            )


@dataclass
class _Times:
    """The cells of one model in one setting, one for each time that it drove the seeds."""

    model: str
    cells: list[tuple[Cell, CellResults]] = field(default_factory=list)


def make_models(driven: Driven) -> Outputs:
    """Make the table of models."""
    blocks: dict[str, dict[str, _Times]] = {}
    for cell, records in zip(driven.cells, driven.records, strict=True):
        swept = {key: value for key, value in cell.swept.items() if key != f"{LLM}.{EPOCH}"}
        setting, model = _marks(cell.resolved)
        times = blocks.setdefault(setting, {}).setdefault(f"{cell.choices.get(LLM)} {model}", _Times(model))
        times.cells.append((cell, results_of(cell, records, swept)))
    rows: list[ModelRow] = []
    for block in blocks.values():
        firsts = {key: times.cells[0][1] for key, times in block.items()}
        same = {key: _same(driven.folder, times) for key, times in block.items()}
        rows += model_rows([(firsts[key], same[key]) for key in block])
    keys = tuple(dict.fromkeys(key for row in rows for key in row.cell.swept))
    everything = [results for block in blocks.values() for times in block.values() for _, results in times.cells]
    notes = (*_served(driven), *driven.notes)
    kept, screen = (print_models(rows, everything, driven.metrics, keys, notes, s) for s in (False, True))
    table = model_table(rows, keys)
    files = {"models.csv": table.csv().encode(), "models.md": markdown_text(kept).encode()}
    return Outputs(files, (screen,), (table,))


def _marks(resolved: Mapping[str, Any]) -> tuple[str, str]:
    """Mark the setting of a cell, and its model without the time that it drives the seeds."""
    setting = {key: value for key, value in resolved.items() if key not in (LLM, "plugins", "prompts")}
    model = {key: value for key, value in resolved[LLM].items() if key != EPOCH}
    return json.dumps(setting, sort_keys=True), json.dumps(model, sort_keys=True)


def _same(folder: Path, times: _Times) -> Repetition | None:
    """Compare the later times with the first; None where there is one alone."""
    (first, results), *later = times.cells
    if not later:
        return None
    counts = Counter[str]()
    for record in results.records:
        said = dict(_answers(folder, first.folder, record.seed))
        for cell, again in later:
            ended = next(r.outcome.ending for r in again.records if r.seed == record.seed)
            counts["episodes"] += 1
            counts["ended"] += ended is record.outcome.ending
            for asked, answer in _answers(folder, cell.folder, record.seed):
                if asked in said:
                    counts["asked"] += 1
                    counts["answered"] += answer == said[asked]
    return Repetition(len(times.cells), counts["answered"], counts["asked"], counts["ended"], counts["episodes"])


def _answers(folder: Path, cell: str, seed: int) -> Iterator[tuple[str, str]]:
    """Give what was decided in answer to what words at what time."""
    for line in read_transcript(folder / EPISODES / cell / str(seed)):
        calls, value = line.get("calls") or [], line.get("value")
        if calls and isinstance(value, dict) and (decided := chosen(value)):
            words = [message["content"] for message in calls[0]["messages"]]
            yield json.dumps([line["time"], line["purpose"], line["subject"], words]), json.dumps(decided)


def chosen(value: Mapping[str, Any]) -> dict[str, Any]:
    """Reduce an answer to what it decides: an action, who goes first in each pair, or how likely drivers let pass."""
    if "action" in value:
        return {"action": value["action"]}
    firsts = {name: pair["first"] for name, pair in value.items() if isinstance(pair, dict) and "first" in pair}
    return firsts or {name: chance for name, chance in value.items() if isinstance(chance, float)}


def _served(driven: Driven) -> list[str]:
    """Say what servers call the models, where that is another name."""
    manifest = read_manifest(driven.folder)
    told = manifest.versions if manifest else {}
    names = {name.removeprefix("model "): served for name, served in told.items() if name.startswith("model ")}
    return [
        f"{name}: its server calls it {served}."
        for name, served in names.items()
        if not (name.endswith(served) or served.endswith(name))
    ]
