"""Every YAML in conf/ is a constructor call that works, stands in its own file and says what it is."""

import inspect
from pathlib import Path

import pytest
import yaml
from remembered import experience, filled

from codriving.config.build import build
from codriving.config.choices import EXPERIMENTS, LISTED, choices, describe
from codriving.config.compose import compose
from codriving.config.locate import conf_dir, experiments_dir
from codriving.config.schema import GROUPS, OPTIONAL
from codriving.config.training import TRAININGS
from codriving.config.validate import validate

SNAPSHOT = ("memory", "frozen")

CHOICES = [(group, name) for group in GROUPS for name in choices(group)]


@pytest.mark.parametrize(("group", "name"), CHOICES)
def test_choice_builds(group: str, name: str, tmp_path: Path) -> None:
    # A snapshot is named by whoever recalls from it.
    needs = [f"memory.file={filled(tmp_path / 'm.sqlite', [experience()])}"] if (group, name) == SNAPSHOT else []
    node = compose([f"{group}={name}", *needs])[group]
    if node is None:
        assert group in OPTIONAL
        return
    made = build(node, key=group)
    hidden = set(inspect.signature(type(made)).parameters) - set(node)
    assert not hidden, f"defaults live in YAML alone, but {group}/{name}.yaml does not show {hidden}"


@pytest.mark.parametrize("name", choices(EXPERIMENTS))
def test_experiment_composes_to_a_valid_config(name: str) -> None:
    validate(compose([f"{EXPERIMENTS}={name}"]))


def test_default_config_is_valid() -> None:
    validate(compose([]))


def test_every_group_has_a_choice_and_every_folder_is_a_group() -> None:
    assert {path.name for path in conf_dir().iterdir() if path.is_dir()} == {*GROUPS, TRAININGS}
    assert all(choices(group) for group in LISTED)


@pytest.mark.parametrize("path", sorted(conf_dir().rglob("*.yaml")) + sorted(experiments_dir().glob("*.yaml")), ids=str)
def test_yaml_begins_with_a_sentence(path: Path) -> None:
    assert describe(path).endswith(".")


@pytest.mark.parametrize(("group", "name"), CHOICES)
def test_every_number_says_its_unit_or_range(group: str, name: str) -> None:
    file = choices(group)[name]
    numbers = {key for key, value in yaml.safe_load(file.read_text()).items() if isinstance(value, int | float | list)}
    for line in file.read_text().splitlines():
        key = line.partition(":")[0]
        if key in numbers:
            assert "#" in line, f"{file.name}: {key} needs a comment with its meaning and unit"
