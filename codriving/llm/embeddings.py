"""Texts to vectors by an embedding model, through LiteLLM; retried and bounded in time like every other request."""

import asyncio
import sys
from collections.abc import Sequence
from dataclasses import replace
from math import isfinite
from typing import Any

from codriving.errors import ConfigError, ModelError, ModelUnavailableError
from codriving.llm.attempts import Retries, Sleep
from codriving.llm.connections import LARGEST, at_most
from codriving.llm.faults import CallError, FaultKind, fault_of
from codriving.llm.loop import loop
from codriving.llm.send import NO_KEY, load_litellm, provider_of
from codriving.llm.settings import check_address, read_key

ATTEMPTS = 5  # How often a request is sent at most

_LARGEST_VECTOR = 200_000  # Of 8,192 numbers, generously written [bytes]

_LARGEST = 64_000_000  # Of all that are asked for at once [bytes]


def _tell(retry: object) -> None:
    print(retry, file=sys.stderr, flush=True)


class EmbeddingModel:
    """An embedding model of one server.

    Args:
        api_base: Address of the server; None for the provider's own.
        key_env: Name of the environment variable that holds the key; None sends none.
        deadline: How long one attempt may take [s].

    Raises:
        ConfigError: If a setting breaks its rule.
    """

    def __init__(
        self, model: str, api_base: str | None, key_env: str | None, deadline: float, sleep: Sleep = asyncio.sleep
    ) -> None:
        if not model.strip():
            raise ConfigError("embedding_model must be the name of a model, got an empty text")
        check_address("embedding_api_base", api_base)
        if not 0.1 <= deadline <= 3600:
            raise ConfigError(f"embedding_deadline must be 0.1 to 3600 s, got {deadline:g}")
        self.model, self.api_base, self.key_env, self.deadline = model, api_base, key_env, deadline
        self._retries = Retries(model, ATTEMPTS, deadline, _tell, sleep)

    def embed(self, texts: Sequence[str]) -> list[list[float]]:
        """Embed some texts in one request.

        Raises:
            ModelUnavailableError: If the server does not answer, retries included.
            ModelError: If it must be mended: no key, no such model, no server.
        """
        if not texts:
            return []
        try:
            return loop().run(self._embed(list(texts), ATTEMPTS))
        except CallError as fault:
            failed = fault
        if failed.kind.passes and failed.kind is not FaultKind.UNREACHABLE:
            raise ModelUnavailableError(f"{self.model}: {self._where} {failed}")
        raise self._unusable(failed)

    def try_out(self, text: str) -> list[list[float]]:
        """Embed one text, before anything depends on it, with one more attempt at most.

        Raises:
            ModelError: If the server does not answer, or must be mended.
        """
        try:
            return loop().run(self._embed([text], 2))
        except CallError as fault:
            failed = fault
        raise self._unusable(failed)

    @property
    def _where(self) -> str:
        return self.api_base or f"the provider of {self.model}"

    def _unusable(self, failed: CallError) -> ModelError:
        return ModelError(
            f"the embedding model {self.model} cannot be used: {self._where} {failed}; check "
            "memory.embedding_model, memory.embedding_api_base and memory.embedding_key_env"
        )

    async def _embed(self, texts: list[str], attempts: int) -> list[list[float]]:
        names = ("embedding model", "memory.embedding_api_base", "memory.embedding_key_env")
        key = read_key(self.key_env, self.api_base, *names)
        await load_litellm()

        response, _ = await replace(self._retries, attempts=attempts).run(
            lambda: self._retries.within_deadline(self._send(texts, key)), lambda fault: fault.kind.passes
        )
        return self._vectors(response, len(texts))

    async def _send(self, texts: list[str], key: str | None) -> Any:  # noqa: ANN401
        litellm = await load_litellm()
        try:
            with at_most(min(LARGEST + _LARGEST_VECTOR * len(texts), _LARGEST)):
                return await litellm.aembedding(
                    model=self.model,
                    custom_llm_provider=provider_of(self.model, self.api_base),
                    input=texts,
                    api_base=self.api_base,
                    api_key=key or NO_KEY,
                    timeout=self.deadline,
                    max_retries=0,
                    num_retries=0,
                    encoding_format="float",
                )
        except Exception as error:
            fault = fault_of(error, key)
        # Outside the handler: the library's exception, which may quote the key, is not dragged along as context.
        raise fault

    def _vectors(self, response: Any, wanted: int) -> list[list[float]]:  # noqa: ANN401
        """Read the vectors in the order of the texts."""
        try:
            entries = [entry if isinstance(entry, dict) else dict(entry) for entry in response.data]
            entries.sort(key=lambda entry: int(entry.get("index", 0)))
            vectors = [[float(x) for x in entry["embedding"]] for entry in entries]
        except (TypeError, ValueError, KeyError, AttributeError) as error:
            raise CallError(FaultKind.UNREADABLE, "no embeddings in the answer") from error
        lengths = {len(vector) for vector in vectors}
        if len(vectors) != wanted or len(lengths) != 1 or not all(isfinite(x) for v in vectors for x in v):
            raise CallError(FaultKind.UNREADABLE, f"{wanted} vectors of one length with finite numbers expected")
        return vectors
