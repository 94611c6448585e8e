"""What tells an object of a user's: values, code, and what the code names; not comments, lines or names of modules."""

import os
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


def of_code(code: str) -> Any:
    """What is called Mine in a notebook with such code."""
    space: dict[str, Any] = {"__name__": "__main__"}
    exec(code, space)
    return space["Mine"]


def made(**changed: object) -> type[Any]:
    """The class of a notebook, with what was changed in it."""
    return of_code(CLASS.format(**{**USUAL, **changed}))  # type: ignore[no-any-return]


def test_it_does_not_depend_on_comments_and_lines() -> None:
    assert identity_of(made()(3.0)) == identity_of(made(comment="# a\n    # b")(3.0))


SEVERAL = """
from enum import Enum
from functools import cache
from random import choice, random
class Gap(Enum): NEAR = 3.0
@cache
def helper(x): return x in {"one", "two", "three"}
class Mine:
    names = {"one", "two", "three"}
    near = {Gap.NEAR: frozenset(names)}
    def act(self, world): return choice(world) + random() + helper(world)
"""


@pytest.mark.parametrize("code", [CLASS.format(**USUAL), SEVERAL])
def test_it_is_the_same_in_each_process(code: str) -> None:
    asked = (
        "from codriving.config.object_identity import identity_of\n"
        f"space = {{'__name__': '__main__'}}\nexec({code!r}, space)\nprint(identity_of(space['Mine']()))"
    )
    seeds = [{**os.environ, "PYTHONHASHSEED": seed} for seed in ("1", "2")]
    done = [
        subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True, env=seed).stdout
        for seed in seeds
    ]
    assert done == [f"{identity_of(of_code(code)())}\n"] * 2


CATCHES = """
class Mine:
    def act(self, world):
        try:
            self.order(world)
{after}            self.decide(world)
{caught}
"""

CAUGHT = "        except ValueError:\n            pass\n"

# Code with a place, and what two users write there.
CHANGES = {
    "what is caught": (CATCHES, {"after": "", "caught": CAUGHT}, {"after": f"{CAUGHT}        else:\n", "caught": ""}),
    "arguments": (
        "def f(x, {y}): return y\nclass Mine:\n    def act(self): return f(1, (2,))",
        {"y": "y"},
        {"y": "*y"},
    ),
    "kept results": (
        "import functools\n@functools.cache\ndef f(x): return {x}\nclass Mine:\n    def act(self): return f(1)",
        {"x": "x"},
        {"x": "-x"},
    ),
    "cached_property": (
        "import functools\nclass Mine:\n    @functools.cached_property\n    def far(self): return {x}",
        {"x": 1},
        {"x": 2},
    ),
    "singledispatch": (
        "import functools\n@functools.singledispatch\ndef f(x): return x\n@f.register\ndef g(x: int): return {x}\n"
        "class Mine:\n    def act(self): return f(1)",
        {"x": 1},
        {"x": 2},
    ),
    "value of a member": (
        "from enum import Enum\nclass Gap(Enum): NEAR = {x}\nclass Mine: gap = Gap.NEAR\ndel Gap",
        {"x": "[1]"},
        {"x": "[2]"},
    ),
    "method of a member": (
        "from enum import Enum\nclass Gap(Enum):\n    NEAR = 1\n    def far(self): return {x}\n"
        "class Mine: gap = Gap.NEAR\ndel Gap",
        {"x": 1},
        {"x": 2},
    ),
    "method of a value": ("class Mine: rank = {{'CAV1': {x}}}.get", {"x": 1}, {"x": 2}),
    "metaclass": (
        "class Meta(type):\n    def __call__(cls): return {x}\nclass Mine(metaclass=Meta): pass",
        {"x": 1},
        {"x": 2},
    ),
    "kind of a number": ("class Far(float): far = {x}\nclass Mine: gap = Far(3)", {"x": 1}, {"x": 2}),
    "docstring that is used": (
        "class Mine:\n    def act(self):\n        '{x}'\n        return '{x}'",
        {"x": "One."},
        {"x": "Two."},
    ),
    "module of a function": ("from {x} import sqrt\nclass Mine: rank = sqrt", {"x": "math"}, {"x": "cmath"}),
    "order of a dictionary": ("class Mine: rank = dict({x})", {"x": "a=1, b=2"}, {"x": "b=2, a=1"}),
}


@pytest.mark.parametrize("what", CHANGES)
def test_a_change_of_code_is_noticed(what: str) -> None:
    code, *both = CHANGES[what]
    first, second, again = (identity_of(of_code(code.format(**words))) for words in (*both, both[0]))
    assert first == again
    assert first != second


def test_the_words_of_a_docstring_the_order_of_attributes_and_what_was_cached_are_no_part_of_it() -> None:
    code = (
        "import functools\nclass Mine:\n    def act(self):\n        '{x}'\n        return 'one'\n"
        "    @functools.cached_property\n    def far(self): return 3"
    )
    cls = of_code(code.format(x="One."))
    assert identity_of(cls) == identity_of(of_code(code.format(x="Two.")))
    one, other = cls(), cls()
    one.gap, one.limit = 1, 2
    other.limit, other.gap = 2, 1
    assert other.far == 3
    assert identity_of(one) == identity_of(other)


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
