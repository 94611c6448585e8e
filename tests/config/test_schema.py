"""The keys of the root, their types and their ranges."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.config.schema import NODES, ROOT, check_root
from codriving.errors import ConfigError

PLAIN: dict[str, Any] = {
    "episodes": 20,
    "seed": 0,
    "workers": "auto",
    "run": None,
    "output": "outputs",
    "experiment": "run",
    "render": False,
    "prompts": None,
    "plugins": [],
    "shard": None,
    **{name: {"_target_": "codriving.x.Y"} for name in NODES},
}


def test_the_plain_config_passes() -> None:
    check_root(PLAIN)
    assert set(ROOT) <= set(PLAIN)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("episodes", 0),
        ("episodes", 100_001),
        ("episodes", 2.0),
        ("episodes", "ten"),
        ("episodes", True),
        ("episodes", None),
        ("seed", -1),
        ("seed", 2**31),
        ("workers", 0),
        ("workers", 257),
        ("workers", "many"),
        ("run", "a/b"),
        ("run", ".."),
        ("run", ".hidden"),
        ("run", ""),
        ("run", 7),
        ("output", ""),
        ("output", None),
        ("experiment", None),
        ("render", 1),
        ("render", "yes"),
        ("render", None),
        ("plugins", "my_package"),
        ("plugins", ["not a package"]),
        ("plugins", None),
        ("scenario", None),
    ],
)
def test_broken_rules_are_named(key: str, value: object) -> None:
    with pytest.raises(ConfigError) as err:
        check_root({**PLAIN, key: value})
    assert str(err.value).startswith(f"{key} must ")
    assert repr(value) in str(err.value)


@pytest.mark.parametrize(("key", "value"), [("run", "first-2_b.c"), ("workers", 3), ("plugins", ["a", "b.c"])])
def test_good_values_pass(key: str, value: object) -> None:
    check_root({**PLAIN, key: value})


def test_a_node_without_class_is_refused() -> None:
    check_root({**PLAIN, "memory": None})
    with pytest.raises(
        ConfigError, match="memory has no _target_, so no class would read shots; choose one with memory=<name> first"
    ):
        check_root({**PLAIN, "memory": {"shots": 3}})


def test_unknown_key_hints_at_the_closest() -> None:
    with pytest.raises(ConfigError, match=r"^unknown key episdes; did you mean episodes\? keys of the config: "):
        check_root({**PLAIN, "episdes": 3})


def test_missing_key() -> None:
    with pytest.raises(ConfigError, match="seed is missing"):
        check_root({key: value for key, value in PLAIN.items() if key != "seed"})


@given(st.text(max_size=12))
def test_a_run_name_is_one_folder_below_the_output(name: str) -> None:
    if ROOT["run"].allows(name):
        assert "/" not in name
        assert "\\" not in name
        assert not name.startswith(".")
        assert name.isascii()
        assert not any(c.isspace() for c in name)
