"""A config as text that composes to the same, and a fingerprint of what results depend on."""

import pytest
import yaml

from codriving.config.compose import compose
from codriving.config.show import WITHOUT_EFFECT, fingerprint, show


def test_shown_config_reads_back_the_same() -> None:
    resolved = compose(["run=2026_01", "cda=prescriptive"])
    assert yaml.safe_load(show(resolved)) == resolved


@pytest.mark.parametrize("override", ["episodes=3", "workers=2", "output=elsewhere", "run=again", "launcher=serial"])
def test_fingerprint_ignores_what_has_no_effect(override: str) -> None:
    assert fingerprint(compose([override])) == fingerprint(compose([]))
    assert override.partition("=")[0] in WITHOUT_EFFECT


@pytest.mark.parametrize("override", ["seed=1", "scenario.cavs=5", "cda.negotiation=false", "metrics=authors"])
def test_fingerprint_sees_what_has(override: str) -> None:
    assert fingerprint(compose([override])) != fingerprint(compose([]))


def test_fingerprint_does_not_depend_on_the_order_of_keys() -> None:
    resolved = compose([])
    assert fingerprint(dict(reversed(resolved.items()))) == fingerprint(resolved)


def test_fingerprint_ignores_how_a_model_is_asked_and_sees_which_one() -> None:
    model = ["llm=custom", "llm.api_base=http://127.0.0.1:1/v1"]
    plain = fingerprint(compose(model))
    for setting in ("max_cost=2.0", "max_concurrency=2", "cache=replay", "cache_file=other", "api_key_env=MY_KEY"):
        assert fingerprint(compose([*model, f"llm.{setting}"])) == plain
    for setting in ("model=openai/other", "temperature=0.5", "max_tokens=5", "ask_plain=true", "api_base=null"):
        assert fingerprint(compose([*model, f"llm.{setting}"])) != plain
