"""What a CAV decides in a scene, by the built-in rules: the table in ``golden/``."""

from collections.abc import Callable
from pathlib import Path

import pytest
from golden import Section, decided, sections, setting
from worlds import Junction

from codriving.datatypes.situation import Situation
from codriving.reasoning.safety.assessment import ThreeLayers

TABLE = sections(Path(__file__).parent / "golden" / "decisions.md")


@pytest.mark.parametrize("section", TABLE, ids=[section.title for section in TABLE])
def test_what_is_decided_is_what_the_table_says(section: Section, road: Callable[[str], Junction]) -> None:
    found = {}
    for value, _ in section.rows:
        seen = setting(section.scene, value).safety_input(road(section.road))
        assessed = ThreeLayers().assess(seen)
        found[value] = decided(Situation(seen.scene, seen.conflicts, seen.order, (), assessed))
    assert found == dict(section.rows)
