"""The page on stress names every axis, row and column, and its commands can be given."""

import re
import shlex
from pathlib import Path

import pytest

from codriving.commands import stress_command
from codriving.commands.stress import SHARED
from codriving.config.choices import CONTROLS, choices, taking_part
from codriving.config.compose import compose
from codriving.config.stress import stress_axis
from codriving.reports.stress import breaking_table, stress_table

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "stress.md").read_text(encoding="utf-8")
OTHERS = (*taking_part("stress")[1:], *taking_part(CONTROLS))
ROWS = [*(("codriving", cda) for cda in SHARED), *((name,) for name in OTHERS)]
COMMANDS = [shlex.split(line, comments=True)[2:] for line in re.findall(r"^ {4}(codriving stress .*)$", PAGE, re.M)]


@pytest.mark.parametrize("name", choices("stress"))
def test_axis_is_documented_with_its_levels(name: str) -> None:
    axis = stress_axis(name)
    values = [label.removesuffix(f" {axis.unit}") for label in axis.labels]
    assert re.search(rf"^\| `{name}` \|.*\| {', '.join(values)} ?{axis.unit} \|$", PAGE, re.M)


@pytest.mark.parametrize("row", ROWS, ids=" ".join)
def test_row_is_documented(row: tuple[str, ...]) -> None:
    if len(row) == 1:
        assert f"`{row[0]}`" in PAGE
    else:
        cda = dict(compose([row[1]])["cda"])
        parts = [part for part in ("state_sharing", "intent_sharing", "negotiation") if not cda[part]]
        own = "/own_view" if parts == ["negotiation"] else ""
        assert f"| `{row[0]} {'_'.join(['no', *parts]) if parts else 'full'}{own}` |" in PAGE


@pytest.mark.parametrize("column", dict.fromkeys((*stress_table([]).keys, *breaking_table([]).keys)))
def test_column_is_documented(column: str) -> None:
    assert f"`{column}`" in PAGE or column in ("success_low", "clean_low")


@pytest.mark.parametrize("words", [words for words in COMMANDS if "--config-dir" not in words], ids=" ".join)
def test_its_commands_can_be_given(words: list[str]) -> None:
    axes, *overrides = words
    assert stress_command(axes).points(overrides, None)


def test_its_own_axis_can_be_used(tmp_path: Path) -> None:
    (tmp_path / "stress").mkdir()
    (example,) = re.findall(r"```yaml\n(.*?)```", PAGE, re.S)
    (tmp_path / "stress" / "distracted.yaml").write_text(example, encoding="utf-8")
    assert stress_axis("distracted", tmp_path).labels == ("0 %", "50 %")
    (words,) = [words for words in COMMANDS if "--config-dir" in words]
    assert stress_command(words[0], tmp_path).points([], tmp_path)
