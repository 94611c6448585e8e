"""Parts: what the shards of a run have driven, each in a folder of its own below ``parts/``, until they are joined."""

from dataclasses import dataclass
from pathlib import Path

from codriving.errors import RunFolderError
from codriving.runs.atomic import write_text
from codriving.runs.json_files import decode, encode

PARTS = "parts"
PART = "part.json"


@dataclass(frozen=True, slots=True)
class Shard:
    """One of several shares of the units of a run, which processes that know nothing of one another can drive."""

    index: int  # From 1
    count: int

    def __str__(self) -> str:
        return f"{self.index}/{self.count}"

    @property
    def folder(self) -> str:
        """Its part, below the folder of the run."""
        return f"{PARTS}/{self.index}-of-{self.count}"

    def has(self, cell: int, episode: int) -> bool:
        """Tell whether it drives an episode, by the places of cell and seed in the run.

        Neither more episodes nor further cells move one to another shard.
        """
        return (cell + episode) % self.count == self.index - 1


@dataclass(frozen=True, slots=True)
class Part:
    """What was driven in a part, and by which command; it holds no secret."""

    index: int
    count: int
    command: str  # What was typed after ``codriving``, settings apart
    arguments: tuple[str, ...]  # The settings, without the shard
    config_dir: str | None  # As it was typed

    @property
    def shard(self) -> Shard:
        """The shard whose part it is."""
        return Shard(self.index, self.count)


def write_part(folder: Path, part: Part) -> None:
    """Write down what a part is."""
    write_text(folder / PART, encode(part))


def read_part(folder: Path) -> Part:
    """Read what a part is.

    Raises:
        RunFolderError: If that is missing or damaged.
    """
    path = folder / PART
    try:
        return decode(Part, path.read_text(encoding="utf-8"))
    except OSError as error:
        raise RunFolderError(f"cannot read {path}: {error.strerror}; {folder} is no part of a run") from error
    except (ValueError, RecursionError) as error:
        raise RunFolderError(f"{path} is damaged ({error}); run the command of this shard again") from error
