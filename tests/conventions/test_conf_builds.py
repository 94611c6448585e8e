"""Every YAML in conf/ is a constructor call that works, stands in its own file and says what it is."""

import inspect
from pathlib import Path

import pytest
import yaml
from remembered import experience, filled

from codriving.config.build import build, validate
from codriving.config.choices import EXPERIMENTS, LISTED, STRESS, SUITE, TRAININGS, choices, describe
from codriving.config.compose import compose
from codriving.config.locate import conf_dir, experiments_dir
from codriving.config.schema import GROUPS, OPTIONAL
from codriving.datatypes.parts import CaseMemory, Model, RuleModel

HANDED = {"llm", "memory"}
"""What a method is handed."""

SNAPSHOT = ("memory", "frozen")

CHOICES = [(group, name) for group in GROUPS for name in choices(group)]


@pytest.mark.parametrize(("group", "name"), CHOICES)
def test_choice_builds(group: str, name: str, tmp_path: Path) -> None:
    # A snapshot is named by the user who recalls from it.
    needs = [f"memory.file={filled(tmp_path / 'm.sqlite', [experience()])}"] if (group, name) == SNAPSHOT else []
    node = compose([f"{group}={name}", *needs])[group]
    if node is None:
        assert group in OPTIONAL
        return
    made = build(node, object, group, given={Model: RuleModel(), CaseMemory: None})
    hidden = set(inspect.signature(type(made)).parameters) - set(node) - HANDED
    assert not hidden, f"defaults live in YAML alone, but {group}/{name}.yaml does not show {hidden}"


@pytest.mark.parametrize(("group", "name"), [(g, name) for g in (EXPERIMENTS, SUITE) for name in choices(g)])
def test_experiments_and_suites_compose_to_a_valid_config(group: str, name: str) -> None:
    validate(compose([f"{group}={name}"]))


def test_default_config_is_valid() -> None:
    validate(compose([]))


def test_every_group_has_a_choice_and_every_folder_is_a_group() -> None:
    assert {path.name for path in conf_dir().iterdir() if path.is_dir()} == {*GROUPS, STRESS, SUITE, TRAININGS}
    assert all(choices(group) for group in LISTED)


def test_yamls_begin_with_a_sentence() -> None:
    paths = [*sorted(conf_dir().rglob("*.yaml")), *sorted(experiments_dir().glob("*.yaml"))]
    assert not [str(path) for path in paths if not describe(path).endswith(".")]


def test_every_number_says_its_unit_or_range() -> None:
    silent = []
    for file in [file for group in GROUPS for file in sorted((conf_dir() / group).glob("*.yaml"))]:
        text = file.read_text(encoding="utf-8")
        numbers = {key for key, value in yaml.safe_load(text).items() if isinstance(value, int | float | list)}
        silent += [
            f"{file.parent.name}/{file.name}: {line}"
            for line in text.splitlines()
            if line.partition(":")[0] in numbers - {"defaults"} and "#" not in line
        ]
    assert not silent, "a number needs a comment with its meaning and unit"
