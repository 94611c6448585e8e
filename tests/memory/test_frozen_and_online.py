"""The two memories that a config can describe: what they refuse, and what a snapshot promises."""

from pathlib import Path
from typing import Any

import pytest
from remembered import description, experience, filled, frozen, interaction, online

from codriving.datatypes.judgement import MetDriver
from codriving.errors import ConfigError, MemoryFileError


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return filled(tmp_path / "m.sqlite", [experience()])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"shots": 0}, "shots must be 1 to 50, got 0"),
        ({"shots": 51}, "shots must be 1 to 50"),
        ({"least_similarity": 1.1}, "least_similarity must be -1 to 1, got 1.1"),
        ({"embedder": "glove"}, "embedder must be one of features, words, litellm"),
    ],
)
def test_settings_out_of_range_are_refused(change: dict[str, Any], said: str, path: Path) -> None:
    for make in (online, frozen):
        with pytest.raises(ConfigError, match=said):
            make(path, **change)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"duplicates": 0.4}, "duplicates must be 0.5 to 1, got 0.4"),
        ({"reflection": "me"}, "reflection must be one of rules, llm, got 'me'"),
        ({"reflections": 0}, "reflections must be 1 to 1000, got 0"),
    ],
)
def test_settings_of_learning_out_of_range_are_refused(change: dict[str, Any], said: str, path: Path) -> None:
    with pytest.raises(ConfigError, match=said):
        online(path, **change)


def test_a_snapshot_needs_a_file(path: Path) -> None:
    with pytest.raises(ConfigError, match="file must name a file of memories, got null"):
        frozen(path, file=None)
    with pytest.raises(ConfigError, match="interactions must be 0 or more, or null for all, got -1"):
        frozen(path, interactions=-1)
    with pytest.raises(MemoryFileError, match="there is no file of memories"):
        frozen(path.with_name("other.sqlite"))
    with pytest.raises(MemoryFileError, match=r"set memory\.embedder to match"):
        frozen(path, embedder="words")


def test_a_snapshot_that_has_changed_is_not_taken_for_the_one_that_was_noted(path: Path) -> None:
    noted = frozen(path).digest
    assert frozen(path, snapshot=noted).digest == noted
    filled(path, [experience(step=9)], first=20_005)
    assert frozen(path).digest != noted
    with pytest.raises(MemoryFileError, match=r"does not hold the snapshot .* it has changed since"):
        frozen(path, snapshot=noted)


def test_what_several_learn_in_one_episode_is_kept_of_all(tmp_path: Path) -> None:
    """With a channel each CAV has a copy of the method, and all have one memory."""
    memory = online(tmp_path / "m.sqlite")
    memory.begin(interaction())
    met = MetDriver("CAV1", "HDV1", 3, {"priority": 1.0}, True, True)
    assert memory.learn([experience(step=1)], [met]) == 1
    assert memory.learn([experience(step=2, ego="CAV2"), experience(description(dttcp=7.5), ego="CAV2")]) == 1
    memory.begin(interaction(20_001))
    assert memory.learn([]) == 0
    kept = frozen(tmp_path / "m.sqlite")
    assert kept.label.endswith(", 2 interactions")
    assert list(kept.encounters()) == [met]
    assert [(e.count, e.ego) for e in kept._snapshot.experiences] == [(2, "CAV1"), (1, "CAV2")]  # type: ignore[union-attr]


def test_a_memory_that_learns_needs_a_place_to_grow_in() -> None:
    with pytest.raises(ConfigError, match=r"memory\.file must name the file"):
        online(None).begin(interaction())
