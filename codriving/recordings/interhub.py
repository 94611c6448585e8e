"""The interactions of an episode in the columns of InterHub's table (X. Jiang et al., 2024)."""

from collections.abc import Iterable, Mapping

import numpy as np

from codriving.datatypes import Kind, Pet, Relation, Track, Trajectory

AROUND = 5.0  # How long before the first and after the second an interaction is shown [s]

TICK = 0.1  # InterHub's time step [s]

_TURNED, _BACK = np.radians(30.0), np.radians(150.0)  # From where on a way turns, or turns back

_BESIDE, _AGAINST = np.radians(45.0), np.radians(135.0)  # Headings that differ by less, or by more


def interhub_rows(
    trajectory: Trajectory, pets: Iterable[Pet], folder: str, scenario: int
) -> tuple[Mapping[str, str | int | float | None], ...]:
    """Give a row for each PET; None for what we do not measure or a trajectory does not say."""
    tracks = {track.id: track for track in trajectory.tracks}
    found: list[Mapping[str, str | int | float | None]] = []
    for pet in pets:
        pair = tracks[pet.first], tracks[pet.second]
        rows = _meeting(*pair)
        times = [(track.first_step + row) * trajectory.step for track, row in zip(pair, rows, strict=True)]
        begins = [track.first_step * trajectory.step for track in pair]
        ends = [(track.first_step + len(track.x) - 1) * trajectory.step for track in pair]
        merges = pet.kind != Relation.CROSSING
        types = ["AV" if track.kind is Kind.CAV else "HV" for track in pair]
        before, after = (
            [
                min(round(AROUND / TICK), int(abs(time - end) / TICK + 1e-6))
                for time, end in zip(times, limits, strict=True)
            ]
            for limits in (begins, ends)
        )
        found.append(
            {
                "dataset": "codriving",
                "folder": folder,
                "scenario_idx": scenario,
                "track_id": f"{pet.first};{pet.second}",
                "start": round(max(min(begins), min(times) - AROUND), 4),
                "end": round(min(max(ends), max(times) + AROUND), 4),
                "intensity": None,
                "PET": round(pet.value, 4),
                "two/multi": "two",
                "vehicle_type": str(types),
                "AV_included": "AV" if "AV" in types else "all_HV",
                "key_agents": f"{pet.first};{pet.second}",
                "pre_int_i": before[0],
                "post_int_i": after[0],
                "pre_int_j": before[1],
                "post_int_j": after[1],
                "path_category": "MP" if merges else ("HO" if _angle(*pair, rows) > _AGAINST else "CP"),
                "path_relation": f"{_relation(*pair, (0, 0))}-{_relation(*pair, (-1, -1), merges)}",
                "turn_label": "-".join(map(_turn, pair)),
                "priority_label": None,
            }
        )
    return tuple(found)


def _meeting(one: Track, other: Track) -> tuple[int, int]:
    """The rows of both at which their paths are nearest."""
    apart = np.hypot(one.x[:, None] - other.x, one.y[:, None] - other.y)
    row, other_row = np.unravel_index(int(apart.argmin()), apart.shape)
    return int(row), int(other_row)


def _angle(one: Track, other: Track, rows: tuple[int, int]) -> float:
    """By how much the headings of two differ at a row of each [rad]."""
    return abs(float(np.remainder(one.heading[rows[0]] - other.heading[rows[1]] + np.pi, 2 * np.pi) - np.pi))


def _relation(one: Track, other: Track, rows: tuple[int, int], merged: bool = False) -> str:
    angle = _angle(one, other, rows)
    if angle < _BESIDE:
        return "M" if merged else "P"
    return "O" if angle > _AGAINST else "C"


def _turn(track: Track) -> str:
    """Left, right, straight or back; with y to the south, a heading grows to the right."""
    turned = float(np.diff(np.unwrap(track.heading)).sum())
    if abs(turned) < _TURNED:
        return "S"
    return "U" if abs(turned) > _BACK else ("R" if turned > 0 else "L")
