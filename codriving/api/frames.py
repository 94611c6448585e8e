"""Stored episodes as data frames; each row begins with what its episode is called in ``episodes.csv``."""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeAlias

from codriving.errors import RunFolderError
from codriving.experiment import StoredEpisode, read_episode
from codriving.runs import check_files, read_decisions, read_record

if TYPE_CHECKING:
    from pandas import DataFrame

Row: TypeAlias = dict[str, Any]

PETS = ("outcome", "first", "second", "kind", "pet")
DECISIONS = ("time", "step", "id", "action", "reason", "allowed", "removed", "conflicts", "memories", "entry")
MOTION = ("time", "id", "kind", "route", "x", "y", "heading", "speed", "acceleration", "action")


def labels(episode: StoredEpisode) -> Row:
    """Say of which row and seed an episode is."""
    cell = episode.cell
    named = {"scenario": cell.scenario, "method": cell.method, "variant": cell.variant, "reasoner": cell.reasoner}
    return {**named, **cell.swept, "seed": episode.seed}


def pet_frame(episodes: Sequence[StoredEpisode], metrics: str | None) -> "DataFrame":
    """Give the PETs of the records."""
    rows, known = list[Row](), dict[str, None]()
    for episode in episodes:
        record = read_record(episode.folder)
        check_files(episode.folder, record)
        known |= dict.fromkeys(record.scores)
        name = metrics or ("standard" if "standard" in record.scores else next(iter(record.scores), ""))
        if name not in record.scores:
            continue
        for pet in record.scores[name].pets:
            values = record.outcome.ending.value, pet.first, pet.second, pet.kind, pet.value
            rows.append({**labels(episode), **dict(zip(PETS, values, strict=True))})
    if metrics is not None and metrics not in known:
        raise RunFolderError(
            f"no episode was scored by metrics={metrics}; it was by {', '.join(known) or 'none'}, and the command of "
            "the run with the other metric and the same run=<name> adds it"
        )
    return _frame(episodes, rows, PETS)


def decision_frame(episodes: Sequence[StoredEpisode]) -> "DataFrame":
    """Give the decisions, a row a CAV and step; of a method that writes them otherwise, a row a step."""
    rows = list[Row]()
    for episode in episodes:
        told = labels(episode)
        for line in read_decisions(episode.folder):
            cavs = line.get("cavs")
            listed = isinstance(cavs, list) and all(isinstance(one, Mapping) for one in cavs)
            at = {"time": line.get("time"), "step": line.get("step")}
            rows += [{**told, **at, **_decision(one)} for one in (cavs if listed and cavs is not None else [line])]
    return _frame(episodes, rows, DECISIONS)


def _decision(entry: Mapping[str, Any]) -> Row:
    def listed(key: str) -> list[Any]:
        value = entry.get(key)
        return list(value) if isinstance(value, list | dict) else []

    return {
        "id": entry.get("id"),
        "action": entry.get("action"),
        "reason": entry.get("reason"),
        "allowed": " ".join(map(str, listed("allowed"))),
        "removed": " ".join(map(str, listed("removed"))),
        "conflicts": len(listed("conflicts")),
        "memories": len(listed("memories")),
        "entry": dict(entry),
    }


def trajectory_frame(episodes: Sequence[StoredEpisode]) -> "DataFrame":
    """Give what was driven."""
    import numpy as np
    from pandas import DataFrame, concat

    parts = []
    for episode in episodes:
        _, trajectory = read_episode(episode)
        for track in trajectory.tracks if trajectory else ():
            time = np.round((track.first_step + np.arange(len(track.x))) * trajectory.step, 4)  # type: ignore[union-attr]
            values = time, track.id, track.kind.value, track.route, track.x, track.y
            motion = dict(
                zip(MOTION, (*values, track.heading, track.speed, track.acceleration, track.action), strict=True)
            )
            parts.append(DataFrame({**labels(episode), **motion}))
    return _numbers(concat(parts, ignore_index=True), episodes) if parts else _frame(episodes, [], MOTION)


def _frame(episodes: Iterable[StoredEpisode], rows: Sequence[Row], columns: Sequence[str]) -> "DataFrame":
    from pandas import DataFrame

    heads = dict.fromkeys(key for episode in episodes for key in labels(episode))
    return _numbers(DataFrame(rows, columns=[*heads, *columns]), episodes)


def _numbers(frame: "DataFrame", episodes: Iterable[StoredEpisode]) -> "DataFrame":
    """Make numbers of the values of a swept key that are."""
    from pandas import to_numeric

    for key in dict.fromkeys(key for episode in episodes for key in episode.cell.swept):
        with suppress(ValueError, TypeError):
            frame[key] = to_numeric(frame[key])
    return frame
