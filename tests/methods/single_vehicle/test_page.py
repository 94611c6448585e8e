"""The page on methods for a single vehicle names every setting with its default."""

from pathlib import Path
from typing import Any

import pytest
from seeing import config

PAGE = (Path(__file__).resolve().parents[3] / "docs" / "methods" / "single-vehicle.md").read_text(encoding="utf-8")
NESTED = ("lanes", "tempers", "others")


def plain(node: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in node.items() if key not in ("_target_", *NESTED)}


IDM, GAME = config("pidm")["driver"], config("noncoop_game")["driver"]


@pytest.mark.parametrize(("key", "value"), [*plain(IDM).items(), *plain(IDM["lanes"]).items(), *plain(GAME).items()])
def test_setting_is_documented_with_its_default(key: str, value: object) -> None:
    shown = f"`{value}`" if isinstance(value, str) else f"{value}"
    assert f"| `{key}` | {shown} |" in PAGE


@pytest.mark.parametrize("key", plain(GAME["tempers"]["normal"]))
def test_tempers_are_documented_with_their_weights(key: str) -> None:
    weights = " | ".join(str(temper[key]) for temper in GAME["tempers"].values())
    assert f"| `{key}` | {weights} |" in PAGE


def test_the_game_minds_others_as_projected_idm_does() -> None:
    assert GAME["others"] == IDM
