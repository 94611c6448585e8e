"""One training in its folder, from its beginning or from where it was stopped; whatever it is that learns."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

from codriving.errors import TrainingError
from codriving.methods import ACTIONS, FAR, NEAR, VERSION, AnyNetwork, Purpose, Trained, load, save
from codriving.runs import whole_file, whole_folder, write_text
from codriving.training.curriculum import world_of
from codriving.training.curve import COLLISION, DURATION, SUCCESS, curve_csv, curve_png
from codriving.training.display import Display
from codriving.training.folder import Stop, TrainingFolder
from codriving.training.settings import MadqnSettings, SingleSettings
from codriving.training.single_trainer import SingleTrainer
from codriving.training.trainer import Trainer
from codriving.training.validation import Grade, examine

AnySettings: TypeAlias = MadqnSettings | SingleSettings
Learner: TypeAlias = Trainer | SingleTrainer

STATE = "state.json"

EXAM_SEEDS = 1000  # Seeds that each exam has for itself

FINAL_SEEDS = 100_000  # How far the seeds of the last validation lie beyond those of the others


def train(settings: AnySettings, folder: TrainingFolder, display: Display, stop: Stop) -> Path:
    """Train, validate and choose."""
    trainer = Trainer(settings) if isinstance(settings, MadqnSettings) else SingleTrainer(settings)
    rows: list[dict[str, Any]] = []
    if folder.checkpoint.exists():
        rows = recall(folder.checkpoint, trainer)["rows"]
        display.note(f"going on after {trainer.decisions} decisions")
    while trainer.decisions < settings.decisions:
        trainer.advance()
        display.advance(trainer.decisions)
        if trainer.decisions >= min((len(rows) + 1) * settings.exam_every, settings.decisions):
            network, said = trainer.network, {"decisions": trainer.decisions}
            rows.append({**trainer.section(), **_columns(_exams(settings, network, settings.exam_seed, None))})
            save(folder.state(trainer.decisions), Trained(network, _purpose(settings, folder, said)))
            store(folder.checkpoint, trainer, {"rows": rows})
            write_text(folder.path / "curve.csv", curve_csv(rows))
            with whole_file(folder.path / "curve.png") as file:
                file.write_bytes(curve_png(rows, f"{settings.learner}, {settings.family}, seed {settings.seed}"))
            display.validated(rows[-1])
        if stop.wanted:
            store(folder.checkpoint, trainer, {"rows": rows})
            raise KeyboardInterrupt
    return _choose(settings, rows, folder, display, trainer)


def _exams(settings: AnySettings, network: AnyNetwork, first: int, episodes: int | None) -> dict[str, Grade]:
    return {
        exam.name: examine(
            exam, network, settings.family, settings.shared, first + k * EXAM_SEEDS, episodes or exam.episodes
        )
        for k, exam in enumerate(settings.exams)
    }


def _columns(grades: Mapping[str, Grade]) -> dict[str, float | None]:
    found: dict[str, float | None] = {"score": round(sum(grade.success for grade in grades.values()) / len(grades), 4)}
    for name, grade in grades.items():
        found[f"{name}.{SUCCESS}"] = round(grade.success, 4)
        found[f"{name}.{COLLISION}"] = round(grade.collision, 4)
        found[f"{name}.{DURATION}"] = None if grade.duration is None else round(grade.duration, 2)
    return found


def _choose(
    settings: AnySettings, rows: list[dict[str, Any]], folder: TrainingFolder, display: Display, trainer: Learner
) -> Path:
    """Validate the best states once more on further seeds, and keep the best of them."""
    best = sorted(rows, key=lambda row: (-row["score"], row["decisions"]))[: settings.finalists]
    finals: list[dict[str, Any]] = []
    first = settings.exam_seed + FINAL_SEEDS
    for row in sorted(best, key=lambda row: int(row["decisions"])):
        grades = _exams(settings, load(folder.state(row["decisions"])).network, first, settings.final_episodes)
        finals.append({"decisions": row["decisions"], **_columns(grades)})
        display.final(finals[-1])
    write_text(folder.path / "finalists.csv", curve_csv(finals))
    winner = max(finals, key=lambda row: (row["score"], -row["decisions"]))
    network = load(folder.state(winner["decisions"])).network
    said = {"decisions": winner.pop("decisions")}
    said["validation"] = {"first_seed": first, "episodes_per_exam": settings.final_episodes, **winner}
    save(folder.best, Trained(network, _purpose(settings, folder, said)))
    return folder.best


def _purpose(settings: AnySettings, folder: TrainingFolder, said: Mapping[str, Any]) -> Purpose:
    models = [exam.environment.environment.driving_model for exam in settings.exams]
    intervals = {model.decision_interval for model in models}
    if len(intervals) > 1:
        raise TrainingError(f"all exams must decide alike often, got intervals of {sorted(intervals)} s")
    taught = {"teacher": settings.teacher} if settings.teacher else {}
    return Purpose(
        method=settings.learner,
        family=settings.family,
        features=VERSION,
        near=NEAR,
        far=FAR,
        decision_interval=intervals.pop(),
        target_speeds=tuple(sorted({model.target_speeds for model in models})),
        actions=tuple(map(str, ACTIONS[settings.family])),
        hidden=settings.hidden,
        training={"command": folder.command, "config": folder.fingerprint, "seed": settings.seed, **taught, **said},
        form=settings.form,
        world=world_of(settings.world),
    )


def store(folder: Path, trainer: Learner, more: dict[str, Any]) -> None:
    """Write a checkpoint."""
    with whole_folder(folder) as partial:
        write_text(partial / STATE, json.dumps({"trainer": trainer.write(partial), "more": more}))


def recall(folder: Path, trainer: Learner) -> dict[str, Any]:
    """Go on from a checkpoint."""
    try:
        state = json.loads((folder / STATE).read_text(encoding="utf-8"))
        trainer.read(folder, state["trainer"])
        return dict(state["more"])
    except (OSError, ValueError, KeyError, TypeError, RuntimeError) as err:
        raise TrainingError(
            f"the checkpoint in {folder} cannot be used ({type(err).__name__}: {err}); "
            "delete the run folder to begin anew"
        ) from err
