"""A tenth of ``make fuzz``, with another seed."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.fuzz.__main__ import Draw, a_place, draws, file, line, process

SEED = 14


@pytest.fixture(scope="module")
def place() -> Iterator[Path]:
    with a_place() as folder:
        yield folder


@pytest.mark.parametrize(("kind", "count"), [(line, 50), (file, 20), (process, 3)])
def test_nothing_is_a_traceback(kind: Draw, count: int, place: Path) -> None:
    assert [fault for _, _, fault in draws(kind, SEED, count, place) if fault] == []
