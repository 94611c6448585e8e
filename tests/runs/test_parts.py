"""Which episodes a shard drives, and what a part keeps of its command."""

from pathlib import Path

import pytest

from codriving.errors import RunFolderError
from codriving.runs.parts import Part, Shard, read_part, write_part


def test_every_episode_is_of_one_shard_and_none_has_more_than_its_share() -> None:
    shards = [Shard(1, 4), Shard(2, 4), Shard(3, 4), Shard(4, 4)]
    units = [(cell, episode) for cell in range(3) for episode in range(5)]
    of = [[shard.index for shard in shards if shard.has(*unit)] for unit in units]
    assert of[:5] == [[1], [2], [3], [4], [1]]
    assert of[5:10] == [[2], [3], [4], [1], [2]]
    assert sorted(of.count([index]) for index in (1, 2, 3, 4)) == [3, 4, 4, 4]


def test_one_shard_of_one_has_everything_and_a_part_is_named_after_its_shard() -> None:
    assert all(Shard(1, 1).has(cell, episode) for cell in range(3) for episode in range(3))
    assert (str(Shard(2, 4)), Shard(2, 4).folder) == ("2/4", "parts/2-of-4")


def test_a_part_is_read_as_it_was_written(tmp_path: Path) -> None:
    part = Part(2, 4, "compare baselines", ("scenario=merge", "'a=x y'"), "my/conf")
    write_part(tmp_path, part)
    assert read_part(tmp_path) == part
    assert part.shard == Shard(2, 4)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"index": "1"}', '{"index": 1, "count": 2, "command": "run"}'])
def test_a_damaged_part_is_refused_in_one_line(tmp_path: Path, text: str) -> None:
    (tmp_path / "part.json").write_text(text)
    with pytest.raises(RunFolderError, match=r"part\.json is damaged \(.*\); run the command of this shard again"):
        read_part(tmp_path)


def test_a_folder_without_one_is_no_part(tmp_path: Path) -> None:
    with pytest.raises(RunFolderError, match="is no part of a run"):
        read_part(tmp_path)
