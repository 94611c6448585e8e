"""The page on environments: its examples run, and it names every setting, weight, feature and scenario."""

import inspect
import re
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from codriving.config.choices import choices
from codriving.datatypes.world import Action
from codriving.gym.observation import FEATURES
from codriving.gym.parallel import ParallelDriving
from codriving.gym.registration import env_id
from codriving.gym.reward import RewardWeights

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "use-as-environment.md").read_text(encoding="utf-8")
ego_id = partial(env_id, face="-ego")
EXAMPLES = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.MULTILINE | re.DOTALL)


def test_examples_run(capsys: pytest.CaptureFixture[str]) -> None:
    assert len(EXAMPLES) > 3
    names: dict[str, Any] = {}
    for example in EXAMPLES:
        exec(example, names)
    assert "Outcome(ending=" in capsys.readouterr().out
    assert str(names["env"].environment.outcome.ending) == "success", "the rules drove last"


def test_every_setting_is_named() -> None:
    given = inspect.signature(ParallelDriving).parameters.values()
    for name in (p.name for p in given if p.kind is p.KEYWORD_ONLY):
        assert f"| `{name}` |" in PAGE


def test_every_weight_is_named_with_its_default() -> None:
    for field in fields(RewardWeights):
        if field.name != "cooperation":
            assert re.search(rf"^\| `{field.name}` \| {field.default:g}[ |]", PAGE, flags=re.MULTILINE), field.name


@pytest.mark.parametrize(
    "name", [*FEATURES, *Action, *map(env_id, choices("scenario")), *map(ego_id, choices("scenario"))]
)
def test_name_is_on_the_page(name: str) -> None:
    assert f"`{name}`" in PAGE
