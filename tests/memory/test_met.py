"""What human drivers did is kept in the file of a memory, episode by episode, and altered for controls."""

import sqlite3
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from remembered import description, experience, frozen, interaction, online

from codriving.datatypes.judgement import MetDriver
from codriving.errors import MemoryFileError
from codriving.memory.embedders import FeatureEmbedder
from codriving.memory.snapshot import open_snapshot
from codriving.memory.store import MemoryStore, merge

MET = [MetDriver("CAV1", f"HDV{k}", k, {"time_ahead": 0.125 * k, "priority": 1.0}, k % 2 == 0, k < 4) for k in range(9)]


def filled(path: Path, *episodes: list[MetDriver], first: int = 20_000) -> Path:
    with MemoryStore(path, FeatureEmbedder(), 0.98) as store:
        for k, met in enumerate(episodes):
            store.add(interaction(first + k), [experience(description(dttcp=k))], encounters=met)
    return path


def test_what_was_met_is_what_is_read_of_so_many_interactions(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", MET[:3], [], MET[3:])
    assert list(frozen(path).encounters()) == MET
    assert list(frozen(path, interactions=2).encounters()) == MET[:3]
    assert frozen(path, interactions=0).encounters() == ()
    learning = online(path)
    learning.begin(interaction(20_002))
    assert list(learning.encounters()) == MET[:3], "of smaller seeds alone"


def test_an_episode_that_is_driven_again_replaces_itself(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", MET[:3], MET[3:])
    before = open_snapshot(path, FeatureEmbedder()).digest
    filled(path, MET[:2])
    assert Counter(m.human for m in frozen(path).encounters()) == Counter(m.human for m in MET if m.human != "HDV2")
    assert open_snapshot(path, FeatureEmbedder()).digest != before


def test_a_memory_without_any_is_as_it_was(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [])
    with sqlite3.connect(path) as file:
        names = {name for (name,) in file.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
    file.close()
    assert names == {"about", "interactions", "experiences", "sightings"}
    filled(path, [], MET, first=20_001)
    assert list(frozen(path).encounters()) == MET


def test_memories_that_are_merged_hold_both(tmp_path: Path) -> None:
    one = filled(tmp_path / "a.sqlite", MET[:3])
    other = filled(tmp_path / "b.sqlite", MET[3:], first=20_005)
    assert merge([one, other], tmp_path / "c.sqlite", FeatureEmbedder(), 0.98) == 2
    assert list(frozen(tmp_path / "c.sqlite").encounters()) == MET


@pytest.mark.parametrize("control", ["verdicts", "situations"])
def test_a_control_deals_out_anew_what_drivers_did(control: str, tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", MET)
    mixed = frozen(path, control=control).encounters()
    assert [replace(m, yielded=True) for m in mixed] == [replace(m, yielded=True) for m in MET]
    assert sum(m.yielded for m in mixed) == 4
    assert [m.yielded for m in mixed] != [m.yielded for m in MET]
    assert mixed == frozen(path, control=control).encounters()


def test_the_control_of_one_rule_knows_no_drivers_and_another_site_is_as_it_is(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", MET)
    assert frozen(path, control="rule").encounters() == ()
    elsewhere = frozen(path, control="elsewhere")
    assert list(elsewhere.encounters()) == MET
    assert elsewhere.label.endswith(", 1 interactions, of another site")


@pytest.mark.parametrize("numbers", ["{", "[]", '{"priority": "x"}', '{"priority": NaN}'])
def test_what_cannot_be_read_is_damaged(numbers: str, tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", MET)
    with sqlite3.connect(path) as file:
        file.execute("UPDATE encounters SET numbers = ? WHERE human = 'HDV3'", (numbers,))
    file.close()
    with pytest.raises(MemoryFileError, match=r"m\.sqlite is damaged"):
        frozen(path)
