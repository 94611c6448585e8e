"""A record that is scored anew stays in step with the list of sums, also if the process is killed in between."""

import dataclasses
from pathlib import Path

import pytest

from codriving.datatypes.record import EpisodeRecord
from codriving.errors import DamagedEpisodeError
from codriving.runs import intact
from codriving.runs.episode_folder import read_record, timing_of, write_episode
from codriving.runs.intact import check_files, rewrite_record

NEXT = [{"step": step} for step in range(5)]


@pytest.fixture
def episode(tmp_path: Path, record: EpisodeRecord) -> Path:
    write_episode(tmp_path / "7", dataclasses.replace(record, participants=()), None, NEXT, timing_of(1.0, []))
    return tmp_path / "7"


def test_a_record_that_is_written_again_is_the_one_that_is_listed(episode: Path) -> None:
    record = read_record(episode)
    rewrite_record(episode, dataclasses.replace(record, scores={}))
    check_files(episode, read_record(episode))
    assert read_record(episode).scores == {}
    assert (episode / "SHA256SUMS").read_text().count("record.json") == 1
    text = (episode / "record.json").read_text()
    (episode / "record.json").write_text(text.replace('"time": 4.2', '"time": 4.3'))
    with pytest.raises(
        DamagedEpisodeError, match=r"record\.json is damaged \(it is not what was written, by SHA256SUMS"
    ):
        check_files(episode, read_record(episode))


@pytest.mark.parametrize("killed_at", [1, 2, 3])
def test_a_kill_while_a_record_is_written_again_damages_nothing(
    episode: Path, killed_at: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = []
    write = intact.write_text

    def killed(path: Path, text: str) -> None:
        calls.append(path)
        if len(calls) == killed_at:
            raise KeyboardInterrupt
        write(path, text)

    monkeypatch.setattr(intact, "write_text", killed)
    with pytest.raises(KeyboardInterrupt):
        rewrite_record(episode, dataclasses.replace(read_record(episode), scores={}))
    check_files(episode, read_record(episode))


@pytest.mark.parametrize("text", ["", "0  record.json\n", "0  ../../../etc/passwd\n", "nonsense", "\xff"])
def test_a_list_that_is_none_is_damage(episode: Path, text: str) -> None:
    record = read_record(episode)
    (episode / "SHA256SUMS").write_bytes(text.encode("latin-1"))
    with pytest.raises(DamagedEpisodeError, match=r"SHA256SUMS is damaged"):
        check_files(episode, record)
