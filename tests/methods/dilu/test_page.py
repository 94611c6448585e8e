"""The page on DiLu names every setting with its default."""

from pathlib import Path
from typing import Any

import pytest

from codriving.config.compose import compose

PAGE = (Path(__file__).resolve().parents[3] / "docs" / "methods" / "dilu.md").read_text(encoding="utf-8")
METHOD: dict[str, Any] = compose(["method=dilu"])["method"]


def plain(node: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in node.items() if isinstance(value, int | float)}


@pytest.mark.parametrize(("key", "value"), [*plain(METHOD).items(), *plain(METHOD["rule"]).items()])
def test_setting_is_documented_with_its_default(key: str, value: object) -> None:
    assert f"| `{key}` | {value} |" in PAGE
