"""What tests compose once is what Hydra composes: configs, choices and refusals."""

from typing import Any

import hydra
import pytest
from composed import composed_once

from codriving.config.compose import compose_named
from codriving.errors import ConfigError

TYPED = [
    (),
    ("suite=paper", "scenario=merge", "scenario.cavs=3", "scenario.hdvs=[1,2]"),
    ("scenario.cavs=3", "suite=paper", "scenario.cavs=4"),
    ("method=noncoop_game", "method.driver.tempers.normal.share=0.5", "output='a,b'", "run=x"),
    ("memory=online", "memory.file='m.sqlite'", "episodes=3", "experiments=learning", "limits=road"),
    ("llm=custom", "llm.extra={a: {b: [1, null]}}", "llm.headers={X-A: 'ü'}", "drivers.shares.distracted=0"),
    ("scenario.typo=3",),
    ("scenario.cavs=",),
    ("scenario.cavs.deeper=1",),
    ("scenario=nowhere", "episodes=3"),
    ("episodes=0",),
    ("scenario.cavs=[1",),
    ("+scenario.typo=3",),
    ("llm.api_key_env=sk-canary",),
]


def outcome(overrides: tuple[str, ...]) -> Any:
    try:
        return compose_named(overrides)
    except ConfigError as error:
        return str(error)


@pytest.mark.parametrize("overrides", TYPED, ids=" ".join)
def test_the_same_comes_out_the_first_and_the_second_time(
    overrides: tuple[str, ...], composed_anew: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    anew = outcome(overrides)
    monkeypatch.setattr(hydra, "compose", composed_once(composed_anew))
    assert outcome(overrides) == anew
    outcome((*overrides, "scenario.cavs=5", "seed=7"))
    assert outcome(overrides) == anew


def test_it_is_composed_once_for_all_values(composed_anew: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[list[str]] = []

    def noted(name: str, overrides: list[str], **more: Any) -> Any:
        calls.append(overrides[1:])
        return composed_anew(name, overrides=overrides, **more)

    monkeypatch.setattr(hydra, "compose", composed_once(noted))
    cavs = [compose_named(["scenario=merge", f"scenario.cavs={n}"])[0]["scenario"]["cavs"] for n in (3, 4, 3)]
    assert (cavs, calls) == ([3, 4, 3], [["scenario=merge"]])
