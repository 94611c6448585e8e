"""The page on configuration names every key and every preset that there is."""

from pathlib import Path

import pytest

from codriving.config.choices import LISTED, choices, values
from codriving.config.schema import ROOT

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "configuration.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", [*ROOT, *LISTED, *choices("cda"), *choices("scenario")])
def test_key_group_or_preset_is_documented(name: str) -> None:
    assert f"`{name}" in PAGE


@pytest.mark.parametrize("group", ["scenario", "cda"])
def test_keys_of_the_group_are_documented(group: str) -> None:
    for file in choices(group).values():
        for key in values(file):
            assert f"| `{key}` |" in PAGE, f"{file.name}: {key}"
