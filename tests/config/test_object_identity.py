"""What tells an object of a user's: values, code, and what the code names; not comments, lines or names of modules."""

import subprocess
import sys
import threading
from typing import Any

import pytest

from codriving.config.object_identity import identity_of
from codriving.errors import ConfigError

CLASS = """
import numpy as np
from dataclasses import dataclass
LIMIT = {limit}
def helper(x):
    return x * {factor}
class Base:
    def bound(self): return {bound}
@dataclass
class Mine(Base):
    {comment}
    gap: float = 2.0
    table: object = None
    def act(self, world):
        return [helper(one) for one in world if one < LIMIT]
"""
USUAL = {"limit": 3, "factor": 2, "bound": 7, "comment": ""}


def made(module: str = "__main__", /, **changed: object) -> type[Any]:
    """The class of a notebook, with what was changed in it."""
    space: dict[str, Any] = {"__name__": module}
    exec(CLASS.format(**{**USUAL, **changed}), space)
    return space["Mine"]


def test_it_does_not_depend_on_comments_lines_or_the_process() -> None:
    code = (
        "from codriving.config.object_identity import identity_of\n"
        f"space = {{'__name__': '__main__'}}\nexec({CLASS.format(**USUAL)!r}, space)\n"
        "print(identity_of(space['Mine'](3.0)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == identity_of(made()(3.0)) == identity_of(made(comment="# a\n    # b")(3.0))


@pytest.mark.parametrize("changed", [{"limit": 4}, {"factor": 3}, {"bound": 8}])
def test_what_its_code_names_is_a_part_of_it(changed: dict[str, object]) -> None:
    assert identity_of(made()) != identity_of(made(**changed))


def test_values_are_a_part_of_it() -> None:
    cls = made()
    values = [2.0, 3.0, True, "3.0", b"3", None, (1, 2), [1, 2], {"a": 1}, {"a": 2}, {1, 2}, range(3), len, cls]
    assert len({identity_of(cls(value)) for value in values}) == len(values)
    ours = [identity_of(cls(table=__import__("numpy").arange(n))) for n in (3, 4)]
    assert ours[0] != ours[1]
    assert identity_of(cls(table={"x", "y", "z"})) == identity_of(cls(table={"z", "y", "x"}))


def test_a_circle_is_no_trouble() -> None:
    cls = made()
    one, other = cls(), cls()
    one.table, other.table = [one], [other]
    assert identity_of(one) == identity_of(other) != identity_of(cls())


def test_what_cannot_be_told_is_refused_unless_the_user_says_it() -> None:
    cls = made()
    held = cls(table=threading.Lock())
    with pytest.raises(ConfigError) as caught:
        identity_of(held)
    assert str(caught.value) == (
        "Mine holds a lock, which cannot be told from another one (cannot pickle '_thread.lock' object); give it an "
        "attribute identity, a text that changes whenever it drives differently"
    )
    held.identity = "first"
    first = identity_of(held)
    held.identity = "second"
    assert first != identity_of(held)
    held.identity = 5
    with pytest.raises(ConfigError, match="identity of Mine must be a text, got 5"):
        identity_of(held)


def test_what_nests_too_deep_is_refused() -> None:
    deep: list[Any] = []
    for _ in range(5000):
        deep = [deep]
    with pytest.raises(ConfigError, match="Mine holds what nests too deep, which cannot be told from another one;"):
        identity_of(made()(table=deep))
