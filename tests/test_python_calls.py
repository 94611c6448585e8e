"""Calls from Python with arguments of the wrong kind: one clear error of this program's, before anything is made."""

from collections.abc import Callable

import pytest

import codriving
from codriving.errors import ConfigError

RUN: Callable[..., object] = codriving.run
COMPARE: Callable[..., object] = codriving.compare
PARALLEL: Callable[..., object] = codriving.parallel_env


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (
            lambda: RUN(["episodes=1"]),
            'a setting is a text such as "episodes=5", and each is an argument of its own; got',
        ),
        (lambda: RUN(None), 'a setting is a text such as "episodes=5", and each is an argument of its own; got None'),
        (lambda: RUN(b"episodes=1"), 'a setting is a text such as "episodes=5", and each is an argument of its own; '),
        (
            lambda: RUN({"episodes": 1}),
            'a setting is a text such as "episodes=5", and each is an argument of its own; ',
        ),
        (lambda: RUN("run=a\0b"), "'run=a\\x00b' holds what is no text, so that no file could hold it; leave it out"),
        (lambda: RUN("run=\udcff"), "'run=\\udcff' holds what is no text, so that no file could hold it; leave it out"),
        (lambda: RUN("episodes=1", config_dir=5), "config_dir must be the path of a folder or None, got 5"),
        (lambda: COMPARE(["baselines"]), "unknown table ['baselines']; write codriving compare TABLE "),
        (lambda: COMPARE("baselines", 5), 'a setting is a text such as "episodes=5", and each is an argument of its '),
        (lambda: COMPARE("baselines", config_dir=["a"]), "config_dir must be the path of a folder or None, got ['a']"),
        (lambda: PARALLEL(["merge"]), "unknown scenario ['merge']; choices: intersection, "),
        (lambda: PARALLEL("merge", config_dir=5), "config_dir must be the path of a folder or None, got 5"),
        (lambda: PARALLEL("merge", cavs=10**400), "scenario.cavs must be a number of less than 19 digits, got 1000"),
        (lambda: PARALLEL("merge", spacing=10**400), "scenario.spacing must be a number of less than 19 digits, got 1"),
    ],
)
def test_it_is_one_error_that_says_what_is_wanted(call: Callable[[], object], said: str) -> None:
    with pytest.raises(ConfigError) as caught:
        call()
    assert str(caught.value).startswith(said)
    assert len(str(caught.value)) < 400
