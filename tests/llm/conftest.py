"""Makes ``loopback``, ``faults`` and ``reading`` importable, and serves."""

import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

HERE = str(Path(__file__).parent)
if HERE not in sys.path:
    sys.path.insert(0, HERE)

from loopback import Loopback  # noqa: E402  (needs the path above)


@pytest.fixture
def loopback() -> Iterator[Loopback]:
    """A server at which nothing goes wrong until its ``plan`` says so."""
    with Loopback() as server:
        yield server


@pytest.fixture
def serve() -> Iterator[Callable[..., Loopback]]:
    """Starts servers with the arguments of ``Loopback``, and closes them all at the end."""
    with ExitStack() as running:

        def start(*args: Any, **kwargs: Any) -> Loopback:
            return running.enter_context(Loopback(*args, **kwargs))

        yield start
