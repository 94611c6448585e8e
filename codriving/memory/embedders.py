"""The embedders by name, as ``memory.embedder`` chooses them."""

from collections.abc import Callable
from dataclasses import dataclass

from codriving.errors import ConfigError
from codriving.memory.embedder import Embedder
from codriving.memory.features import Features
from codriving.memory.words import Words

OWN: dict[str, Callable[[], Embedder]] = {"features": Features, "words": Words}
"""Embedders that need nothing else."""

LITELLM = "litellm"
"""The word for an embedding model through LiteLLM."""


@dataclass(frozen=True, slots=True)
class EmbeddingServer:
    """Where an embedding model is.

    Attributes:
        api_base: Address of the server; None for the provider's own.
        api_key_env: Name of the environment variable that holds the key; None sends none.
        deadline: How long one attempt may take [s].
    """

    model: str
    api_base: str | None
    api_key_env: str | None
    deadline: float


def make_embedder(name: str, server: EmbeddingServer) -> Embedder:
    """Make an embedder.

    Args:
        name: ``features``, ``words`` or ``litellm``.
        server: Where the model is, for ``litellm``.

    Raises:
        ConfigError: If there is no such embedder, or the server's settings cannot be used.
    """
    if name in OWN:
        return OWN[name]()
    if name != LITELLM:
        raise ConfigError(f"embedder must be one of {', '.join([*OWN, LITELLM])}, got {name!r}")
    # What a server needs is imported only where one is asked.
    from codriving.memory.model import ModelEmbedder

    return ModelEmbedder(server.model, server.api_base, server.api_key_env, server.deadline)
