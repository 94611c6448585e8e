"""Where two episodes of one seed part: the first decision that differs, and what became of both."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from codriving.animation import maps_in, number_in, text_in
from codriving.datatypes import Trajectory

Line = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Parting:
    """The first decision that differs."""

    time: float  # When it was made [s]
    changes: tuple[tuple[str, str, str], ...]  # CAV and what it decided in the one and in the other; ``-`` for nothing


Choices = Sequence[tuple[float, Mapping[str, str]]]  # Time [s], and what each CAV decided


def choices_in(lines: Iterable[Line]) -> Choices:
    """Take from the lines of ``decisions.jsonl`` what was decided."""
    return [
        (
            number_in(line, "time") or 0.0,
            {name: text_in(entry, "action") for entry in maps_in(line, "cavs") if (name := text_in(entry, "id"))},
        )
        for line in lines
    ]


def parting(one: Choices, other: Choices) -> Parting | None:
    """Find where the decisions of two episodes part; None if they never do while both are driven."""
    for (time, first), (_, second) in zip(one, other, strict=False):
        names = dict.fromkeys([*first, *second])
        changes = [(n, first.get(n, "-"), second.get(n, "-")) for n in names if first.get(n) != second.get(n)]
        if changes:
            return Parting(time, tuple(changes))
    return None


def same_start(one: Trajectory, other: Trajectory) -> bool:
    """Tell whether the same vehicles start at the same places with the same speeds."""

    def scene(trajectory: Trajectory) -> set[tuple[Any, ...]]:
        return {
            (t.id, *(round(float(v[0]), 3) for v in (t.x, t.y, t.heading, t.speed)))
            for t in trajectory.tracks
            if t.first_step == 0
        }

    return scene(one) == scene(other)
