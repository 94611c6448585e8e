"""What the pages of a memory say of human drivers who were met."""

from pathlib import Path

from remembered import experience, filled, interaction

from codriving.commands.memory_pages import show_page
from codriving.datatypes.judgement import MetDriver
from codriving.memory.embedders import FeatureEmbedder
from codriving.memory.store import MemoryStore


def test_who_let_pass_is_told_where_it_was_kept(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience()])
    assert "let pass" not in show_page(path, 1)
    met = [MetDriver("CAV1", f"HDV{k}", k, {"priority": 1.0}, k < 3, k in (0, 1, 4)) for k in range(7)]
    with MemoryStore(path, FeatureEmbedder(), 0.98) as store:
        store.add(interaction(20_001), [], encounters=met)
    assert "let pass      2 of 3 whom the rules hold back, 1 of 4 others" in show_page(path, 1).splitlines()
