"""The page on scenarios: its defaults are those of the YAML files, and beyond its ranges settings are refused."""

import importlib.util
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from codriving.config.build import build
from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.errors import ConfigError

DOCS = Path(__file__).resolve().parents[2] / "docs"
NUMBER = re.compile(r"-?\d+\.?\d*")
PAGE = (DOCS / "scenarios.md").read_text(encoding="utf-8")


def rows(heading: str) -> Iterator[list[str]]:
    """Cells of the rows of the table under a heading, without its head."""
    section = PAGE.partition(f"\n## {heading}\n")[2].partition("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("|")]
    for line in lines[2:]:
        yield [cell.strip() for cell in line.strip("|").split("|")]


def documented(scenario: str) -> dict[str, tuple[str, str]]:
    """Default and range of each key, as they stand on the page."""
    column = 1 + list(choices("scenario")).index(scenario)
    shared = {row[0]: re.fullmatch(r"(.*) \((.*)\)", row[column]) for row in rows("What all of them share")}
    found = {name: (cell[1], cell[2]) for name, cell in shared.items() if cell}
    found |= {row[0]: (row[1], row[2]) for row in rows(scenario.capitalize())}
    return {name.strip("`"): cells for name, cells in found.items()}


@cache
def node(scenario: str) -> dict[str, Any]:
    return dict(compose([f"scenario={scenario}"])["scenario"])


def written(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(written(v) for v in value)}]"
    return value if isinstance(value, str) else "null" if value is None else f"{value:g}"


@pytest.mark.parametrize("scenario", choices("scenario"))
def test_every_key_stands_on_the_page_with_its_default(scenario: str) -> None:
    defaults = {key: written(value) for key, value in node(scenario).items() if key != "_target_"}
    assert {key: default.removesuffix(" m") for key, (default, _) in documented(scenario).items()} == defaults


@pytest.mark.parametrize(
    ("scenario", "key", "span"),
    [(scenario, key, span) for scenario in choices("scenario") for key, (_, span) in documented(scenario).items()],
)
def test_what_is_beyond_the_range_is_refused_with_the_range(scenario: str, key: str, span: str) -> None:
    default = node(scenario)[key]
    if " to " not in span:
        value = ["backwards"] if isinstance(default, list) else "backwards"
        with pytest.raises(ConfigError, match=rf"scenario\.{key} must be .*one of {span}, got"):
            build({**node(scenario), key: value}, object, "scenario")
        return
    low, high = (float(end) for end in span.split(" to "))
    for beyond in (low - 1, high + 1):
        number = round(beyond) if key in ("cavs", "hdvs", "lanes") else beyond
        value = [number] * len(default) if isinstance(default, list) else number
        with pytest.raises(ConfigError, match=rf"scenario\.{key} must be .*\d to \d") as refusal:
            build({**node(scenario), key: value}, object, "scenario")
        ends = re.findall(r"([\d.]+) to ([\d.]+)", str(refusal.value))[0]
        assert [float(end) for end in ends] == pytest.approx([low, high], abs=0.1)


def test_every_scenario_has_its_picture() -> None:
    for scenario in choices("scenario"):
        assert f"(images/road-{scenario}.svg)" in PAGE
    for page in DOCS.glob("*.md"):
        for picture in re.findall(r"\]\((images/[^)]+)\)", page.read_text(encoding="utf-8")):
            assert (DOCS / picture).is_file(), f"{page.name}: {picture}"


def drawing(name: str) -> Any:
    """A program of docs/images."""
    spec = importlib.util.spec_from_file_location(name, DOCS / "images" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    made = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made)
    return made


def compare(drawn: str, file: str, program: str) -> None:
    """The picture that is stored is the one that is drawn."""
    stored = (DOCS / "images" / file).read_text(encoding="utf-8")
    cure = f"draw {file} again: python docs/images/{program}"
    assert NUMBER.sub("#", drawn) == NUMBER.sub("#", stored), cure
    # Another processor may round the last digit otherwise.
    one, other = ([float(number) for number in NUMBER.findall(text)] for text in (drawn, stored))
    assert one == pytest.approx(other, abs=0.11), cure


def test_pictures_are_of_the_roads_as_they_are() -> None:
    roads = drawing("roads")
    for scenario in choices("scenario"):
        compare(roads.draw(scenario), f"road-{scenario}.svg", "roads.py")


def test_picture_of_the_readme_is_of_what_is_driven() -> None:
    compare(drawing("intersection").draw(), "intersection.svg", "intersection.py")
