"""`codriving exam`: stored questions, asked of models, controls and the rules, without driving."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from time import perf_counter
from typing import Any

from codriving.commands.compare_models import EPOCH, LLM, model_points
from codriving.commands.controls import split_controls
from codriving.config import parse
from codriving.datatypes import Model
from codriving.errors import ConfigError, ModelError, ModelUnavailableError
from codriving.exam import OURS, Answered, mark, read_exam, sit, some
from codriving.experiment import REPLAY, announce, composed, model_of, validated
from codriving.reports import ExamRow, exam_table, markdown_text, print_exam, print_table
from codriving.runs import new_run_path, scrubbed, secrets_of, unwritable, variables_in, write_text

ALWAYS, CONTROLS = "offline", ("first", "random")

KNOWN = ("llm", "epochs", "prompts", "output", "run")  # What an exam takes; a world it takes from its file

EVERY = 20  # So many answers later it is said how far it has come


@dataclass(frozen=True, slots=True)
class ExamOptions:
    """What ``codriving exam`` takes besides settings."""

    most: int | None = None  # Questions that are asked at most
    file: Path | None = None  # An exam of the user's; None takes ours
    config_dir: Path | None = None


def run_exam(overrides: Sequence[str], options: ExamOptions) -> int:
    """Ask, print the table and keep it with all answers.

    Args:
        overrides: ``key=value`` tokens.

    Raises:
        UserError: If a setting, the exam's file or the folder cannot be used, or a model cannot be asked.
    """
    if options.most is not None and options.most < 1:
        raise ConfigError(f"--most must be 1 or more, got {options.most}")
    points = _points(overrides, options.config_dir)
    configs, _ = composed(points, options.config_dir)
    validated(points, configs)
    exam = read_exam(options.file or OURS)
    questions = some(exam, options.most)
    models = [model for config in configs if (model := model_of(config)) is not None]
    for model in models:
        _reach(model)
    folder = _folder(configs[0])
    rows: list[ExamRow] = []
    times: dict[str, list[list[Answered]]] = {}
    seconds: dict[str, float] = {}
    for point, model in zip(points, models, strict=True):
        name, began = model.name, perf_counter()
        key = f"{point.swept[LLM]} {name}"
        try:
            times.setdefault(key, []).append(sit(questions, model, _patience(model), _teller(name, len(questions))))
        except ModelUnavailableError as error:
            raise ModelError(str(error)) from error
        seconds.setdefault(key, perf_counter() - began)
    names = {f"{point.swept[LLM]} {model.name}": model.name for point, model in zip(points, models, strict=True)}
    rows = [ExamRow(names[key], mark(of), seconds[key], len(of)) for key, of in times.items()]
    rows.sort(key=lambda row: row.reasoner.startswith("control"))
    left = "" if len(questions) == len(exam.situations) + len(exam.negotiations) else ", evenly taken of all"
    notes = [
        f"Exam {exam.sha256[:12]}: {len(questions)} questions{left}, of {len(exam.situations)} situations and "
        f"{len(exam.negotiations)} negotiations; seeds {exam.about['seeds']}; judged by {exam.about['judged']}.",
    ]
    page = print_exam(rows, notes)
    secrets = secrets_of(variables_in(configs))
    lines = [line for key, of in times.items() for line in _lines(names[key], of)]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write_text(folder / "exam.csv", exam_table(rows).csv())
        write_text(folder / "exam.md", markdown_text(page))
        write_text(folder / "answers.jsonl", "".join(f"{json.dumps(scrubbed(line, secrets))}\n" for line in lines))
    except OSError as error:
        raise unwritable(folder, error) from error
    print_table(page)
    print(folder / "exam.csv")
    return 0


def _points(overrides: Sequence[str], config_dir: Path | None) -> list[Any]:
    """Give a point for the rules, each control and each model that is named, as often as ``epochs`` says."""
    controls, overrides = split_controls(overrides, usual=True)
    for token in overrides:
        if (key := parse(token).key_or_group.partition(".")[0]) not in KNOWN:
            raise ConfigError(f"an exam takes {', '.join(KNOWN)} and controls, and its world from its file; got {key}")
    named = [t.partition("=")[2] for t in overrides if t.partition("=")[0] == LLM]
    names = dict.fromkeys(
        [ALWAYS, *(CONTROLS if controls else ()), *(n for text in named for n in text.split(",") if n)]
    )
    kept = [token for token in overrides if token.partition("=")[0] != LLM]
    return model_points((), [*kept, f"{LLM}={','.join(names)}"], config_dir)


def _reach(model: Model) -> None:
    """Refuse a model that cannot be reached before anything is asked."""
    if (client := model.chat()) is None or not model.waits:
        return
    client.on_retry = client.on_note = announce
    if model.cache != REPLAY:
        try:
            client.preflight()
        except ModelUnavailableError as error:
            raise ModelError(str(error)) from error


def _patience(model: Model) -> int:
    return int(getattr(model, "fallbacks_at_first", 0))


def _teller(name: str, whole: int) -> Callable[[int], None]:
    """Return what says how far a model has come that takes its time."""
    began = perf_counter()

    def tell(number: int) -> None:
        if number % EVERY == 0 and perf_counter() - began > EVERY:
            announce(f"{name}: {number} of {whole} questions, {perf_counter() - began:.0f} s")

    return tell


def _folder(config: Mapping[str, Any]) -> Path:
    place = Path(config["output"]) / "exam"
    return place / config["run"] if config["run"] else new_run_path(place, datetime.now(UTC))


def _lines(name: str, times: Sequence[Sequence[Answered]]) -> list[dict[str, Any]]:
    """Give what is kept of each answer."""
    return [
        {
            "reasoner": name,
            EPOCH: k + 1,
            "question": one.asked.name,
            "action": None if one.action is None else str(one.action),
            "first": {f"{a} {b}": first for (a, b), first in one.first.items()},
            "yields": list(one.yields),
            "transcript": list(one.lines),
        }
        for k, answers in enumerate(times)
        for one in answers
    ]
