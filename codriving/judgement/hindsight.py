"""What was judged against what the drivers then did, read off the lines of ``decisions.jsonl`` and the trajectory."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from codriving.datatypes import GOES, UNCLEAR, YIELDS, Relation, Track, Trajectory
from codriving.geometry import Array, RoadMap, progress

# Counters of an episode: judgements of which it is known what the driver then did; of these, decided and right ones,
# both kinds of errors, the sum of squared errors of the probability; and how long CAVs were held up by errors [s].
JUDGED, DECIDED, RIGHT, BRIER = "judged", "judged_decided", "judged_right", "judged_squares"
WENT, YIELDED, LOST = "yields_but_went", "goes_but_yielded", "seconds_lost"


def look_back(lines: Sequence[Mapping[str, Any]], trajectory: Trajectory, road_map: RoadMap) -> dict[str, float]:
    """Count right and wrong judgements of an episode; nothing where nothing was judged."""
    judged = [(k, line["time"], cav) for k, line in enumerate(lines) for cav in line.get("cavs", ())]
    judged = [(k, time, cav) for k, time, cav in judged if cav.get("judgements")]
    if not judged:
        return {}
    after = [second["time"] - first["time"] for first, second in pairwise(lines)]
    tracks = {track.id: track for track in trajectory.tracks}
    counts: dict[str, float] = dict.fromkeys((JUDGED, DECIDED, RIGHT, BRIER, WENT, YIELDED, LOST), 0.0)
    places = {name: progress(road_map.paths[t.route], t.x, t.y, t.heading) for name, t in tracks.items()}
    entered: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for k, time, cav in judged:
        held_up = False
        for human, said in cav["judgements"].items():
            pair = (cav["id"], human)
            if not tracks.keys() >= set(pair):
                continue
            if pair not in entered:
                entered[pair] = entries(tracks[cav["id"]], tracks[human], places, road_map, trajectory.step)
            yielded = let_pass(entered[pair], time)
            if yielded is None:
                continue
            counts[JUDGED] += 1
            counts[BRIER] += (said["yields"] - yielded) ** 2
            if said["answer"] != UNCLEAR:
                counts[DECIDED] += 1
                counts[RIGHT] += (said["answer"] == YIELDS) == yielded
                counts[WENT] += said["answer"] == YIELDS and not yielded
                counts[YIELDED] += said["answer"] == GOES and yielded
                held_up |= said["answer"] == GOES and yielded
        counts[LOST] += after[min(k, len(after) - 1)] if held_up and after else 0
    return {name: round(number, 6) for name, number in counts.items()}


def entries(
    cav: Track, human: Track, places: Mapping[str, Array], road_map: RoadMap, step: float
) -> list[tuple[float, float]]:
    """Return when a CAV and a driver have entered each zone of both, in the CAV's order; inf if never [s]."""
    zones = [z for z in road_map.zones(cav.route, human.route) if z.relation is Relation.CROSSING or z.merge_i]
    return [
        (_when(cav, places[cav.id], z.entry_i, step), _when(human, places[human.id], z.entry_j, step))
        for z in sorted(zones, key=lambda z: z.entry_i)
    ]


def let_pass(entered: Sequence[tuple[float, float]], time: float) -> bool | None:
    """Whether a driver let a CAV pass first at the next zone that neither had entered at a time [s].

    Returns:
        None if neither has entered it, or there is no such zone.
    """
    for mine, theirs in entered:
        if min(mine, theirs) > time:
            return None if np.isinf(min(mine, theirs)) else mine < theirs
    return None


def _when(track: Track, places: Array, entry: float, step: float) -> float:
    inside = places > entry
    return (track.first_step + int(np.argmax(inside))) * step if inside.any() else np.inf
