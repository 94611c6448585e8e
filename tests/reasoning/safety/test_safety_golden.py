"""What each layer of the safety check removes, on both sides of each threshold: the tables in ``golden/``."""

from collections.abc import Callable
from pathlib import Path

import pytest
from golden import Section, removals, sections, setting
from worlds import Junction

from codriving.datatypes.world import Action
from codriving.reasoning.safety.adjacent_lane import check_adjacent
from codriving.reasoning.safety.conflict_lane import check_conflicts
from codriving.reasoning.safety.safety_input import SafetyInput
from codriving.reasoning.safety.same_lane import check_ahead, check_behind

LAYERS: dict[str, Callable[[SafetyInput], dict[Action, list[str]]]] = {
    "same_lane": check_ahead,
    "behind": check_behind,
    "adjacent_lane": check_adjacent,
    "conflict_lane": check_conflicts,
}
TABLES = [(name, section) for name in LAYERS for section in sections(Path(__file__).parent / "golden" / f"{name}.md")]


@pytest.mark.parametrize(("layer", "section"), TABLES, ids=[f"{name}: {s.title}" for name, s in TABLES])
def test_a_layer_removes_what_the_table_says(layer: str, section: Section, road: Callable[[str], Junction]) -> None:
    found = {
        value: removals(setting(section.scene, value).safety_input(road(section.road)), LAYERS[layer])
        for value, _ in section.rows
    }
    assert found == dict(section.rows)
