"""Scores of driven episodes: by several metrics at once, and later by another one without driving again."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from math import isclose
from pathlib import Path
from typing import Any

from codriving.config import TARGET, build
from codriving.datatypes import Ending, EpisodeRecord, Metric, Scenario, Score, Simulator
from codriving.errors import RunFolderError
from codriving.metrics import Scorer, with_alone
from codriving.runs import RECORD, UNNAMED, flat, read_trajectory, rewrite_record


def scorers_of(config: Mapping[str, Any]) -> dict[str, Scorer]:
    """Build the metrics of a cell, by the name of their scores."""
    node, plugins = config["metrics"], config["plugins"]
    nodes = {"": node} if TARGET in node else node
    made = {
        name: Scorer(build(each, Metric, "metrics", plugins), settings_of_metric(each)) for name, each in nodes.items()
    }
    return {name or scorer.metric.name: scorer for name, scorer in made.items()}


def settings_of_metric(node: Mapping[str, Any]) -> dict[str, str]:
    """Give the settings of a metric, as JSON by dotted key."""
    return flat({key: value for key, value in node.items() if key != TARGET})


def scored(episodes: Iterable[tuple[Path, EpisodeRecord]], config: Mapping[str, Any]) -> list[EpisodeRecord]:
    """Score what has been driven by the metrics that it has no score of.

    The record is written again, whole or not at all; that of an episode of release 0.1 stays as it is.
    """
    found, road, scorers, simulator = [], None, None, None
    for folder, record in episodes:
        lacking = [name for name, node in config["metrics"].items() if lacks(record, name, settings_of_metric(node))]
        if lacking:
            scorers = scorers or scorers_of(config)
            road = road or build(config["scenario"], Scenario, "scenario", config["plugins"]).road
            if (trajectory := read_trajectory(folder, record)) is None:
                raise RunFolderError(f"{folder} has no trajectory to score; delete it and run again")
            try:
                if any(scorers[name].metric.against_alone for name in lacking):
                    simulator = simulator or build(config["environment"], Simulator, "environment", config["plugins"])
                    trajectory = with_alone(trajectory, simulator, record.seed, scorers.values())
                new = {name: scorers[name].score_stored(trajectory, record.outcome, road) for name in lacking}
                if (kept := record.scores.get(UNNAMED)) is not None:
                    new = {
                        name: replace(kept, settings=s.settings) if same_metric(s, kept) else s
                        for name, s in new.items()
                    }
                record = replace(record, scores={**record.scores, **new})
                if UNNAMED not in record.scores:
                    rewrite_record(folder, record)
            except OSError as error:
                raise RunFolderError(f"cannot write {folder / RECORD}: {error.strerror or error}") from error
            except Exception as error:
                raise RunFolderError(f"cannot score {folder} by {', '.join(lacking)}: {error}") from error
        found.append(record)
    return found


def lacks(record: EpisodeRecord, name: str, settings: Mapping[str, str]) -> bool:
    """Tell whether a driven episode has no score of a metric with these settings."""
    if record.outcome.ending is Ending.ERROR:
        return False
    score = record.scores.get(name)
    return score is None or score.settings != settings


def same_metric(new: Score, kept: Score) -> bool:
    """Tell whether a score that release 0.1 kept is by the same metric as a new one.

    Where vehicles merge, that release took PETs at another place, and it had no further numbers.
    """
    return alike(*(replace(score, pets=(), numbers=(), clean=None) for score in (new, kept)))


def alike(one: object, other: object) -> bool:
    """Tell whether two scores are the same but for the rounding of the stored trajectory.

    Release 0.1 did not write which metric a score is of; the score that it kept was taken before the rounding.
    """
    if is_dataclass(one) and is_dataclass(other):
        names = {field.name for field in fields(one)} - {"settings"}
        return type(one) is type(other) and all(alike(getattr(one, name), getattr(other, name)) for name in names)
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(alike(value, other[key]) for key, value in one.items())
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return len(one) == len(other) and all(map(alike, one, other))
    return isclose(one, other, abs_tol=0.01) if isinstance(one, float) and isinstance(other, float) else one == other


def names_of_scores(metrics: Sequence[tuple[str, Mapping[str, str]]]) -> list[str]:
    """Name the scores of one episode: by their metrics, and by the settings where two have one name."""
    names = [name for name, _ in metrics]
    return [
        name if names.count(name) == 1 else " ".join([name, *(f"{key}={value}" for key, value in settings.items())])
        for name, settings in metrics
    ]
