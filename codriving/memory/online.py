"""``memory=online``: learns while a batch is driven, each episode from those with smaller seeds."""

from collections.abc import Sequence
from pathlib import Path

from codriving.datatypes import Experience, Interaction, MetDriver
from codriving.errors import ConfigError
from codriving.memory.embedders import EmbeddingServer
from codriving.memory.recall import RetrievalMemory
from codriving.memory.store import MemoryStore

REFLECTIONS = ("rules", "llm")


class OnlineMemory(RetrievalMemory):
    """A memory that grows by one episode after another.

    What an episode recalls is what episodes with smaller seeds have left; so a batch that was interrupted goes on as if
    it had not been, and an episode that is driven again replaces what it left before.
    """

    learns = True
    label = "online"

    def __init__(
        self,
        file: str | None,
        shots: int,
        least_similarity: float,
        duplicates: float,
        reflection: str,
        reflections: int,
        embedder: str,
        embedding_model: str,
        embedding_api_base: str | None,
        embedding_key_env: str | None,
        embedding_deadline: float,
    ) -> None:
        if not 0.5 <= duplicates <= 1:
            raise ConfigError(f"duplicates must be 0.5 to 1, got {duplicates:g}")
        if reflection not in REFLECTIONS:
            raise ConfigError(f"reflection must be one of {', '.join(REFLECTIONS)}, got {reflection!r}")
        if not 1 <= reflections <= 1000:
            raise ConfigError(f"reflections must be 1 to 1000, got {reflections}")
        server = EmbeddingServer(embedding_model, embedding_api_base, embedding_key_env, embedding_deadline)
        super().__init__(shots, least_similarity, embedder, server)
        self.file, self.duplicates = file, duplicates
        self.reflections = reflections if reflection == "llm" else 0

    def prepare(self) -> None:
        """Try the embedder and the file, before the first episode."""
        self._embedder.try_out()
        if self.file is not None:
            with self._store() as store:
                store.check()

    def begin(self, interaction: Interaction) -> None:
        """Begin an episode: what was learnt with smaller seeds is what can be recalled."""
        self._interaction = interaction
        self._learnt: list[Experience] = []
        self._met: list[MetDriver] = []
        self._new = 0
        with self._store() as store:
            self._snapshot = store.snapshot(before=interaction.seed)

    def learn(self, experiences: Sequence[Experience], encounters: Sequence[MetDriver] = ()) -> int:
        """Keep what was learnt in the episode that has begun: with a channel each CAV learns by itself, one by one."""
        self._learnt += experiences
        self._met += encounters
        before = self._new
        with self._store() as store:
            self._new = store.add(self._interaction, self._learnt, encounters=self._met)
        return self._new - before

    def _store(self) -> MemoryStore:
        if self.file is None:
            raise ConfigError("memory.file must name the file that memory=online grows in, got null")
        return MemoryStore(Path(self.file).expanduser(), self._embedder, self.duplicates)
