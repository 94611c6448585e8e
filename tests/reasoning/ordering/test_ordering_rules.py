"""The YAML of each order builds its rule, with the values that the class itself has."""

import inspect

import pytest
import yaml

from codriving.config.build import build
from codriving.config.locate import conf_dir

NAMES = {"fcfs": "fcfs", "idfst": "idfst", "mcts": "mcts", "optimal": "bruteforce"}


@pytest.mark.parametrize(("file", "name"), NAMES.items())
def test_yaml_builds_the_rule_of_its_name(file: str, name: str) -> None:
    node = yaml.safe_load((conf_dir() / "order" / f"{file}.yaml").read_text(encoding="utf-8"))
    rule = build(node, object, "rule")
    assert rule.name == name
    assert rule.variant == ""
    defaults = {key: p.default for key, p in inspect.signature(type(rule)).parameters.items()}
    assert {key: value or None for key, value in node.items() if key != "_target_"} == {
        key: value or None for key, value in defaults.items()
    }
