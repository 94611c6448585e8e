"""An experience as a row of the file, and back; what is damaged is refused and never guessed."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from codriving.datatypes.action import Action
from codriving.datatypes.experience import Description, Effect, Experience, Verdict
from codriving.memory.embedder import Vectors

COLUMNS = ("vector", "action", "verdict", "scene", "conflict", "passing", "numbers", "kinds", "effect", "lesson")
"""The columns of ``experiences`` after the number, in their order."""


def to_row(experience: Experience, vector: Vectors) -> tuple[Any, ...]:
    """Write an experience as the values of ``COLUMNS``.

    Raises:
        ValueError: If a number in it is not finite.
    """
    d = experience.description
    return (
        vector.astype("<f4").tobytes(),
        str(experience.action),
        str(experience.verdict),
        d.scene,
        d.conflict,
        d.order,
        _json(d.numbers),
        _json(d.kinds),
        _json(asdict(experience.effect)),
        experience.lesson,
    )


def from_row(row: tuple[Any, ...], step: int = 0, ego: str = "") -> Experience:
    """Read an experience from the values of ``COLUMNS``.

    Raises:
        ValueError: If something in it cannot be read.
    """
    _, action, verdict, scene, conflict, passing, numbers, kinds, effect, lesson = row
    try:
        description = Description(scene, conflict, passing, json.loads(numbers), json.loads(kinds))
        return Experience(
            description, Action(action), Verdict(verdict), Effect(**json.loads(effect)), lesson, step, ego
        )
    except (TypeError, KeyError) as error:
        raise ValueError(str(error)) from error


def vectors_of(blobs: list[bytes], dimension: int) -> Vectors:
    """Join vectors as they are stored into one array.

    Returns:
        Vectors (n, dimension).

    Raises:
        ValueError: If one has another length, or holds what is no finite number.
    """
    if any(len(blob) != 4 * dimension for blob in blobs):
        raise ValueError(f"a vector does not have {dimension} numbers")
    vectors = np.frombuffer(b"".join(blobs), dtype="<f4").reshape(len(blobs), dimension).astype(np.float32)
    if not np.isfinite(vectors).all():
        raise ValueError("a vector holds a number that is not finite")
    return vectors


def _json(values: Mapping[str, Any]) -> str:
    return json.dumps(dict(values), sort_keys=True, separators=(",", ":"), allow_nan=False, ensure_ascii=False)
