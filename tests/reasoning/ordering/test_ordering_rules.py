"""The YAML of each ordering method builds its rule, with the values that the class itself has."""

import inspect

import pytest
import yaml

from codriving.config.build import build
from codriving.config.locate import conf_dir

NAMES = ("fcfs", "idfst", "mcts", "bruteforce")


@pytest.mark.parametrize("name", NAMES)
def test_yaml_builds_the_rule_of_its_name(name: str) -> None:
    node = yaml.safe_load((conf_dir() / "method" / f"{name}.yaml").read_text(encoding="utf-8"))["rule"]
    rule = build(node, object, "rule")
    assert rule.name == name
    assert rule.variant == ""
    defaults = {key: p.default for key, p in inspect.signature(type(rule)).parameters.items()}
    assert {key: value or None for key, value in node.items() if key != "_target_"} == {
        key: value or None for key, value in defaults.items()
    }
