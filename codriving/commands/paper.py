"""`codriving experiment paper`: everything that the paper shows, driven one after another, and one page of it."""

import csv
import io
import shlex
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from codriving.commands.experiment import experiment_command
from codriving.commands.learn import Lessons
from codriving.commands.memory_build import INTERACTIONS
from codriving.commands.report import NAME, ReportOptions, reported_run, run_report
from codriving.commands.run import Command, how_to_go_on, print_configs, report, stopped
from codriving.config import ALL_OF_PAPER, ExperimentFile, experiment_file, experiment_names, key_of, written
from codriving.errors import ConfigError, RunFolderError
from codriving.experiment import HaltedError, Interrupted, driving, make_plan, read_film
from codriving.pages import Case, PaperPart, ReportedRun, find_case, lesson, paper_page, replay_link
from codriving.runs import write_text

if TYPE_CHECKING:
    from codriving.animation import EpisodeFilm

OUTPUT, RUNS, PAGE = Path("outputs/paper"), "runs", "index.html"

TABLES = ("ablation.csv", "comparison.csv", "learn.csv", "summary.csv", "episodes.csv")  # What a part may link

ROAD = 0.7  # Share of a frame that shows the road

OURS = ("run", "experiment", "shard")  # Keys that this command sets


def run_paper(overrides: Sequence[str], config_dir: Path | None = None, show_only: bool = False) -> int:
    """Drive what the paper shows, and write the page after each part; gives the exit code of a run.

    Raises:
        UserError: If the config or a run folder cannot be used.
    """
    overrides = written(overrides)
    if own := [key_of(token) for token in overrides if key_of(token) in OURS]:
        raise ConfigError(
            f"experiment {ALL_OF_PAPER} sets {own[0]} itself; output=DIR chooses another place than {OUTPUT}"
        )
    given = [token.partition("=")[2] for token in overrides if key_of(token) == "output"]
    place = Path(given[-1]) if given else OUTPUT
    specs = papers_experiments()
    for spec in specs if show_only else ():
        print(f"---\n# {spec.name}: {spec.shows}")
        if spec.table != "learning":
            print_configs(experiment_command(spec, spec.name).points(overrides, config_dir), config_dir)
    if show_only:
        return 0
    code, typed = 0, shlex.join(["codriving", "experiment", ALL_OF_PAPER, *overrides, *_folder(config_dir)])
    parts = [_part(spec, place, overrides, config_dir) for spec in specs]
    for index, spec in enumerate(specs):
        print(f"{spec.name}, {index + 1} of {len(specs)}: {spec.shows}.", file=sys.stderr, flush=True)
        own = [token for token in overrides if spec.table == "learning" or key_of(token) != INTERACTIONS]
        tokens = [*own, f"output={place}", f"experiment={RUNS}", f"run={spec.name}"]
        ended, driven = _drive(spec, tokens, typed, config_dir)
        code = max(code, ended)
        if code > 1:
            return code
        if driven or parts[index].run is None:
            parts[index] = _part(spec, place, overrides, config_dir, anew=True)
        print(write_page(parts, place, typed), flush=True)
    return code


def papers_experiments() -> list[ExperimentFile]:
    """Read the experiments of the paper, in its order."""
    found = [experiment_file(name) for name in experiment_names()]
    return sorted((spec for spec in found if spec.shows), key=lambda spec: spec.shows)


def _drive(spec: ExperimentFile, tokens: Sequence[str], typed: str, config_dir: Path | None) -> tuple[int, int]:
    """Drive a part; gives the exit code, and how many episodes were driven."""
    try:
        if spec.table == "learning":
            lessons = Lessons.of(tokens, config_dir, spec)
            learnt, files = lessons.learn()
            if learnt.failed:
                return report(learnt, typed), learnt.driven
            command, plan = Command(f"experiment {spec.name}", make_outputs=lessons.outputs), lessons.tests(files)
        else:
            command = experiment_command(spec, f"experiment {spec.name}")
            plan = make_plan(command.points(tokens, config_dir), config_dir)
            command.check(plan)
        with driving(plan) as batch:
            finished = batch.finished(plan, command.make_outputs)
    except (Interrupted, HaltedError) as stop:
        return stopped(stop, typed), 0
    return report(finished, how_to_go_on(plan, command.name, tokens, finished.folder)), finished.driven


def write_page(parts: Sequence[PaperPart], place: Path, typed: str) -> str:
    """Write the page of what has been driven."""
    try:
        place.mkdir(parents=True, exist_ok=True)
        write_text(place / PAGE, paper_page(parts, typed))
    except OSError as error:
        why = error.strerror or error
        raise RunFolderError(f"cannot write {place / PAGE}: {why}; choose another output=") from error
    there = sum(part.run is not None for part in parts)
    return f"Page: {place / PAGE}, {there} of {len(parts)} parts."


def _folder(config_dir: Path | None) -> list[str]:
    return ["--config-dir", str(config_dir)] if config_dir else []


def _part(
    spec: ExperimentFile, place: Path, overrides: Sequence[str], config_dir: Path | None, anew: bool = False
) -> PaperPart:
    """Read what has been driven of a part, and make its report if there is none, or anew."""
    folder, at = place / RUNS / spec.name, f"{RUNS}/{spec.name}"
    kind = "case" if spec.case else spec.table if spec.table in ("ablation", "learning") else "comparison"
    command = shlex.join(["codriving", "experiment", spec.name, *overrides])
    numbers = tuple(csv.DictReader(io.StringIO((spec.file.parent / spec.numbers).read_text(encoding="utf-8"))))
    made = PaperPart(spec.name, spec.shows, spec.sentence, kind, command, numbers)
    if not (folder / "summary.csv").is_file():
        return made
    options = ReportOptions(config_dir=config_dir)
    run = reported_run(folder, spec.name, options, several=False)
    if anew or not (folder / NAME).is_file():
        run_report([folder], options)
    links = [("Report with replays", f"{at}/{NAME}")]
    links += [(name, f"{at}/{name}") for name in TABLES if (folder / name).is_file()]
    case = _case(spec, run) if spec.case else None
    if case:
        links.insert(0, ("Replay this start, both side by side", f"{at}/{NAME}{replay_link(case)}"))
    return replace(made, run=run, links=links, case=case, frames=_frames(case) if case else ())


def _case(spec: ExperimentFile, run: ReportedRun) -> Case | None:
    """Find a start that shows what the case is about; None where there are no two rows to show it in."""
    if spec.table != "learning":
        (good, bad, *_), names = (*run.rows, None, None), tuple(spec.rows)
        return find_case(good, bad, (names[0], names[1])) if good and bad else None
    tested = sorted((row for row in run.rows if not lesson(row)[1]), key=lambda row: lesson(row)[0])
    return find_case(tested[-1], tested[0], ("with memory", "without memory")) if len(tested) > 1 else None


def _frames(case: Case) -> list[tuple[str, str, bytes]]:
    """Draw three moments of both episodes: when they part, when the first of them has ended, and between."""
    films = {
        name: read_film(row.seeds[case.seed].folder, row.road, 0.75)
        for name, row in zip(case.names, (case.good, case.bad), strict=True)
    }
    last = min(film.duration for film in films.values())
    first = min(case.time or 0.0, last)
    found = []
    for name, film in reversed(films.items()):
        for time in dict.fromkeys((first, round((first + last) / 2, 1), last)):
            found.append((name, f"{time:.1f} s", _png(film, time)))
    return found


def _png(film: "EpisodeFilm", time: float) -> bytes:
    """Draw the road; the words of the panel beside it would be too small to read."""
    from PIL import Image

    frame, out = film.frame(time), io.BytesIO()
    road = frame[:, : round(ROAD * frame.shape[1]), :3]
    Image.fromarray(road).quantize(128).save(out, "PNG", optimize=True)
    return out.getvalue()
