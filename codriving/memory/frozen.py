"""``memory=frozen``: a snapshot that is recalled from and never changed, so that tables depend on no order."""

from functools import lru_cache
from pathlib import Path

from codriving.errors import ConfigError, MemoryFileError
from codriving.memory.altered import WORDS, Alteration, altered
from codriving.memory.embedders import EmbeddingServer, make_embedder
from codriving.memory.recall import RetrievalMemory
from codriving.memory.snapshot import Snapshot, open_snapshot

AUTO = "auto"  # The word for the snapshot as it is when a run begins


class FrozenMemory(RetrievalMemory):
    """A snapshot, as ``codriving memory build`` leaves it."""

    def __init__(
        self,
        file: str | None,
        snapshot: str,
        interactions: int | None,
        shots: int,
        least_similarity: float,
        embedder: str,
        embedding_model: str,
        embedding_api_base: str | None,
        embedding_key_env: str | None,
        embedding_deadline: float,
        control: Alteration = "none",
    ) -> None:
        if file is None:
            raise ConfigError("file must name a file of memories, got null; make one with codriving memory build")
        if interactions is not None and interactions < 0:
            raise ConfigError(f"interactions must be 0 or more, or null for all, got {interactions}")
        server = EmbeddingServer(embedding_model, embedding_api_base, embedding_key_env, embedding_deadline)
        super().__init__(shots, least_similarity, embedder, server)
        path = Path(file).expanduser()
        # Size and time of the last change tell, without reading a file, that it has changed.
        stat = path.stat() if path.exists() else None
        stamp = (stat.st_mtime_ns, stat.st_size) if stat is not None else None
        found = self._snapshot = _opened(path, embedder, server, interactions, stamp, control)
        self.digest = found.digest
        if snapshot not in (AUTO, self.digest):
            raise MemoryFileError(
                f"{file} does not hold the snapshot {snapshot[:12]} but {self.digest[:12]}: it has changed since; "
                "restore it, or set memory.snapshot=auto and another run=<name>"
            )
        self._path = path
        words = f", {WORDS[control]}" if control != "none" else ""
        self.label = f"frozen {self.digest[:8]}, {found.interactions} interactions{words}"

    def prepare(self) -> None:
        """Try the embedder, whose vectors have to be as long as those of the file."""
        self._embedder.try_out()
        made = self._embedder.dimension
        if self._snapshot is not None and made is not None and made != self._snapshot.dimension:
            raise MemoryFileError(
                f"{self._path} holds vectors of {self._snapshot.dimension} numbers, and {self._embedder.name} makes "
                f"{made}; name the model that it was made with, or build it again"
            )


@lru_cache(maxsize=8)
def _opened(
    path: Path, embedder: str, server: EmbeddingServer, interactions: int | None, stamp: object, control: Alteration
) -> Snapshot:
    """Open a file; all cells and episodes of a process share what was read, as long as the file stays as it is."""
    return altered(open_snapshot(path, make_embedder(embedder, server), interactions), control)
