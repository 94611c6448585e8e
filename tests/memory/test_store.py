"""The store: one file is the truth, whatever happens to its writer."""

import os
import signal
import sqlite3
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from remembered import description, experience, filled, interaction, noise

from codriving.datatypes.experience import Verdict
from codriving.datatypes.world import Action
from codriving.errors import MemoryFileError
from codriving.memory.embedders import FeatureEmbedder, WordEmbedder
from codriving.memory.snapshot import Snapshot, open_snapshot
from codriving.memory.store import MemoryStore

FAR = [description(dttcp=0.5), description(dttcp=7.5, speed=1.0), description(relation="none", speed=3.0)]
"""Situations that are not alike."""

TESTS = Path(__file__).resolve().parents[1]


def opened(path: Path, interactions: int | None = None) -> Snapshot:
    return open_snapshot(path, FeatureEmbedder(), interactions)


def counts(path: Path) -> list[int]:
    return [entry.count for entry in opened(path).experiences]


def test_what_was_kept_is_what_is_read(tmp_path: Path) -> None:
    learnt = [experience(FAR[0]), experience(FAR[1], Action.SLOWER, Verdict.EASED, step=7, ego="CAV2")]
    kept = opened(filled(tmp_path / "m.sqlite", learnt)).experiences
    assert [entry.experience for entry in kept] == learnt


def test_what_is_alike_is_kept_once_with_a_count(tmp_path: Path) -> None:
    same = [experience(FAR[0], step=1), experience(FAR[0], step=2), experience(FAR[1], step=3)]
    path = filled(tmp_path / "m.sqlite", same, [experience(FAR[0])])
    assert counts(path) == [3, 1]


@pytest.mark.parametrize("change", [{"action": Action.SLOWER}, {"verdict": Verdict.EASED}])
def test_another_action_or_verdict_is_another_experience(change: dict[str, object], tmp_path: Path) -> None:
    learnt = [experience(FAR[0]), experience(FAR[0], step=4, **change)]  # type: ignore[arg-type]
    assert counts(filled(tmp_path / "m.sqlite", learnt)) == [1, 1]


def test_the_same_episode_driven_again_replaces_itself(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience(FAR[0])], [experience(FAR[1])])
    before = opened(path).digest
    with MemoryStore(path, FeatureEmbedder(), 0.98) as store:
        store.add(interaction(20_001), [experience(FAR[1])])
        assert store.add(interaction(20_001), [experience(FAR[2])]) == 1
    assert [entry.experience.description for entry in opened(path).experiences] == [FAR[0], FAR[2]]
    with MemoryStore(path, FeatureEmbedder(), 0.98) as store:
        store.add(interaction(20_001), [experience(FAR[1])])
    assert opened(path).digest == before


def test_the_first_interactions_are_what_the_file_held_then(tmp_path: Path) -> None:
    episodes = [[experience(FAR[0])], [experience(FAR[1]), experience(FAR[0], step=5)], [], [experience(FAR[2])]]
    whole = filled(tmp_path / "whole.sqlite", *episodes)
    for n in range(5):
        path = filled(tmp_path / f"{n}.sqlite", *episodes[:n]) if n else None
        part = opened(whole, n)
        assert part.interactions == n
        assert len(part) == (len(opened(path)) if path else 0)
        if path:
            assert part.digest == opened(path).digest
            assert [e.count for e in part.experiences] == counts(path)


def test_fewer_interactions_than_asked_for_are_refused(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience()])
    with pytest.raises(MemoryFileError, match=r"memory\.interactions is 2, but .* is of 1 interactions"):
        opened(path, 2)


def test_what_is_recalled_before_a_seed_knows_nothing_of_later_ones(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience(FAR[0])], [experience(FAR[1])], first=5)
    with MemoryStore(path, FeatureEmbedder(), 0.98) as store:
        assert [len(store.snapshot(before=seed)) for seed in (5, 6, 7)] == [0, 1, 2]


def test_what_was_opened_does_not_change_when_the_file_grows(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience(FAR[0])])
    before = opened(path)
    filled(path, [experience(FAR[1])], first=20_007)
    assert len(before) == 1
    assert len(opened(path)) == 2
    assert opened(path).digest != before.digest


def test_the_same_episodes_give_the_same_bytes(tmp_path: Path) -> None:
    episodes = [[experience(FAR[0])], [experience(FAR[1])]]
    one, two = (filled(tmp_path / name, *episodes) for name in ("1.sqlite", "2.sqlite"))
    assert one.read_bytes() == two.read_bytes()


@pytest.mark.parametrize("wrong", [float("nan"), float("inf")])
def test_a_vector_that_is_no_number_is_refused_and_nothing_is_kept(wrong: float, tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience(FAR[0])])
    vectors = FeatureEmbedder().embed([FAR[1], FAR[2]])
    vectors[1, 0] = wrong
    with MemoryStore(path, FeatureEmbedder(), 0.98) as store:
        with pytest.raises(MemoryFileError, match="not finite"):
            store.add(interaction(20_001), [experience(FAR[1]), experience(FAR[2])], vectors)
        assert len(store.snapshot()) == 1
        store.add(interaction(20_001), [experience(FAR[1])])
    assert counts(path) == [1, 1]


def test_a_vector_of_another_length_is_refused(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience(FAR[0])])
    with (
        MemoryStore(path, FeatureEmbedder(), 0.98) as store,
        pytest.raises(MemoryFileError, match="vectors of 104 numbers expected, got 8"),
    ):
        store.add(interaction(20_001), [experience(FAR[1])], noise(0, 1))


def test_a_file_of_another_embedder_is_refused(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience()])
    with pytest.raises(MemoryFileError, match=r"made with the embedder features-1, and words-1 is asked for"):
        open_snapshot(path, WordEmbedder())
    with pytest.raises(MemoryFileError, match=r"set memory\.embedder to match"):
        MemoryStore(path, WordEmbedder(), 0.98)


def edit(path: Path, statement: str) -> None:
    connection = sqlite3.connect(path)
    connection.execute(statement)
    connection.commit()
    connection.close()


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        ("PRAGMA user_version = 9", r"another version \(layout 9, not 1\)"),
        ("PRAGMA application_id = 7", "is no file of memories"),
        ("UPDATE about SET value = '99' WHERE key = 'dimension'", "holds vectors of 99 numbers"),
        ("UPDATE experiences SET vector = zeroblob(12)", "does not have 104 numbers"),
        (f"UPDATE experiences SET vector = X'{'0000C07F' * 104}'", "not finite"),
        ("UPDATE experiences SET verdict = 'fine'", "is damaged"),
        ("UPDATE experiences SET numbers = '{'", "is damaged"),
        ("DROP TABLE sightings", "is damaged"),
    ],
)
def test_a_file_that_was_changed_is_refused(statement: str, said: str, tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience()])
    edit(path, statement)
    with pytest.raises(MemoryFileError, match=said):
        opened(path)


def test_other_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(MemoryFileError, match="there is no file of memories"):
        opened(tmp_path / "none.sqlite")
    (tmp_path / "text.sqlite").write_text("nothing of the kind, and long enough to have a header" * 4)
    with pytest.raises(MemoryFileError, match="cannot be read as a file of memories"):
        opened(tmp_path / "text.sqlite")


def test_a_place_where_nothing_can_be_written_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(MemoryFileError, match="cannot write the memory"):
        filled(tmp_path / "file" / "m.sqlite", [experience()])


def test_two_writers_lose_nothing_and_see_each_other(tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    with MemoryStore(path, FeatureEmbedder(), 0.98) as one, MemoryStore(path, FeatureEmbedder(), 0.98) as two:
        for k in range(4):
            (one if k % 2 else two).add(
                interaction(20_000 + k), [experience(FAR[0], step=k), experience(FAR[k % 3], ego="CAV2")]
            )
        two.add(interaction(20_001), [experience(FAR[2])])
        one.add(interaction(20_009), [experience(FAR[2])])
    kept = opened(path)
    assert kept.interactions == 5
    assert sorted(counts(path)) == [3, 5]


_WRITER = """
import sys
sys.path.insert(0, sys.argv[1])
from pathlib import Path
from remembered import description, experience, interaction
from codriving.memory.embedders import FeatureEmbedder
from codriving.memory.store import MemoryStore
store, first = MemoryStore(Path(sys.argv[2]), FeatureEmbedder(), 0.98), int(sys.argv[3])
for k in range(int(sys.argv[4])):
    told = [description(dttcp=0.5 * (j % 15), speed=0.7 * (j % 11)) for j in range(k, k + 20)]
    store.add(interaction(first + k), [experience(d, step=j) for j, d in enumerate(told)])
    print(k, flush=True)
"""


def writer(path: Path, first: int, episodes: int) -> "subprocess.Popen[str]":
    """Another process that adds one episode after another and says so."""
    words = [sys.executable, "-c", _WRITER, str(TESTS), str(path), str(first), str(episodes)]
    return subprocess.Popen(words, stdout=subprocess.PIPE, text=True, cwd=TESTS.parent)


def test_two_processes_that_write_at_once_lose_nothing(tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    both = [writer(path, first, 12) for first in (30_000, 40_000)]
    assert [process.communicate(timeout=60) and process.returncode for process in both] == [0, 0]
    kept = opened(path)
    assert kept.interactions == 24
    assert sum(counts(path)) == 24 * 20


@pytest.mark.parametrize("after", [1, 6])
def test_a_killed_writer_leaves_whole_episodes_and_a_file_that_goes_on(after: int, tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    process = writer(path, 30_000, 10_000)
    assert process.stdout is not None
    for _ in range(after):
        process.stdout.readline()
    os.kill(process.pid, signal.SIGKILL)
    process.stdout.close()
    assert process.wait(timeout=60) == -signal.SIGKILL
    kept = opened(path)
    assert kept.interactions >= after
    assert sum(counts(path)) == 20 * kept.interactions
    with MemoryStore(path, FeatureEmbedder(), 0.98) as store:
        store.add(interaction(1), [experience()])
    assert opened(path).interactions == kept.interactions + 1


def test_a_change_that_was_cut_off_in_the_middle_is_undone(tmp_path: Path) -> None:
    """As after a kill between two writes of one transaction: the journal is there, and the file is half changed."""
    path = filled(tmp_path / "m.sqlite", [experience(FAR[0])], [experience(FAR[1])])
    digest = opened(path).digest
    script = (
        "import os, sqlite3, sys\n"
        "c = sqlite3.connect(sys.argv[1], isolation_level=None)\n"
        "c.execute('PRAGMA cache_size = 1'); c.execute('PRAGMA cache_spill = 1'); c.execute('BEGIN IMMEDIATE')\n"
        "for k in range(400):\n"
        '    c.execute("INSERT INTO experiences SELECT NULL, vector, action, verdict, scene, conflict, passing, "\n'
        '              "numbers, kinds, effect, lesson FROM experiences LIMIT 1")\n'
        "c.execute('DELETE FROM interactions')\n"
        "os.kill(os.getpid(), 9)\n"
    )
    assert subprocess.run([sys.executable, "-c", script, str(path)], check=False).returncode == -signal.SIGKILL
    assert path.with_name("m.sqlite-journal").exists()
    assert opened(path).digest == digest
    assert not path.with_name("m.sqlite-journal").exists()


def test_recall_gives_the_text_and_the_numbers_of_what_was_kept(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience(FAR[0]), experience(FAR[0], step=9)], [experience(FAR[1])])
    kept = opened(path)
    ((memory, *others),) = kept.search(FeatureEmbedder().embed([FAR[0]]), 2, -1.0)
    assert (memory.id, memory.action, memory.verdict, memory.count) == (1, Action.FASTER, Verdict.INTENSIFIED, 2)
    assert memory.similarity == pytest.approx(1.0, abs=1e-5)
    assert (
        "20 m and 2.5 s before the zone, it 24 m and 3.0 s, second: FASTER. Your action has intensified the conflict"
        in memory.text
    )
    assert len(memory.text) <= 400
    assert others[0].similarity < memory.similarity
    assert kept.search(FeatureEmbedder().embed([FAR[0]]), 5, 0.999) == [(memory,)]
    assert np.isfinite(memory.similarity)
