"""CDA levels, their names, and the presets of the configuration."""

import itertools
from typing import Any

import pytest
from worlds import FULL

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.errors import ConfigError
from codriving.reasoning.sharing.sharing import CdaLevel


def preset(*overrides: str) -> CdaLevel:
    level = build(compose(overrides)["cda"], object)
    assert isinstance(level, CdaLevel)
    return level


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({}, "full"),
        ({"binding": True}, "full/binding"),
        ({"state_sharing": False}, "no_state_sharing"),
        ({"safety_check": False}, "no_safety_check"),
        ({"negotiation": False}, "no_negotiation/own_view"),
        ({"negotiation": False, "own_order": "independent"}, "no_negotiation/independent"),
        ({"intent_sharing": False}, "no_intent_sharing"),
    ],
)
def test_a_variant_says_what_is_missing(change: dict[str, Any], name: str) -> None:
    assert CdaLevel(**{**FULL, **change}).variant == name


def test_levels_that_behave_differently_have_different_names() -> None:
    toggles = [name for name, value in FULL.items() if isinstance(value, bool)]
    names = []
    for values in itertools.product((True, False), repeat=len(toggles)):
        change = dict(zip(toggles, values, strict=True))
        if change["binding"] and not change["negotiation"]:
            continue
        names.append(CdaLevel(**{**FULL, **change}).variant)
    assert len(set(names)) == len(names)


def test_an_order_that_is_not_negotiated_cannot_bind() -> None:
    with pytest.raises(ConfigError, match=r"cda\.binding=true needs cda\.negotiation=true"):
        CdaLevel(**{**FULL, "negotiation": False, "binding": True})


def test_an_unknown_reading_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"own_view, same_rule or independent, got 'mine'"):
        CdaLevel(**{**FULL, "own_order": "mine"})


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("full", {}),
        ("agreement_seeking", {}),
        ("prescriptive", {"binding": True}),
        ("intent_sharing", {"negotiation": False}),
        ("status_sharing", {"negotiation": False, "intent_sharing": False}),
    ],
)
def test_presets_are_the_classes_of_the_standard(name: str, change: dict[str, Any]) -> None:
    assert preset(f"cda={name}") == CdaLevel(**{**FULL, **change})


def test_the_default_is_full_and_every_toggle_can_be_set() -> None:
    assert preset() == CdaLevel(**FULL)
    assert not preset("cda.safety_check=false").safety_check
    assert preset("cda=intent_sharing", "cda.own_order=same_rule").own_order == "same_rule"
