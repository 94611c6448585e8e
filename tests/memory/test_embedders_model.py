"""An embedding model behind HTTP: batches, retries, keys, and what is said if it cannot be used."""

import asyncio
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from loopback import Loopback
from remembered import description, experience, frozen, interaction, online

from codriving.errors import MemoryFileError, ModelError, ModelUnavailableError
from codriving.llm.embeddings import ATTEMPTS, EmbeddingModel
from codriving.memory.embedders import EmbeddingServer, ModelEmbedder

KEY, SECRET = "TEST_EMBEDDING_KEY", "sk-embedding-canary"


@pytest.fixture
def server() -> Iterator[Loopback]:
    with Loopback() as running:
        yield running


def model(server: Loopback, key_env: str | None = None) -> EmbeddingModel:
    async def at_once(seconds: float) -> None:
        await asyncio.sleep(0)

    return EmbeddingModel("some-embedder", server.url, key_env, 10.0, at_once)


def test_all_texts_of_a_step_are_one_request_and_each_is_asked_for_once(server: Loopback) -> None:
    embedder = ModelEmbedder(EmbeddingServer("some-embedder", server.url, None, 10.0))
    told = [description(dttcp=0.5), description(dttcp=6.0), description(dttcp=0.5)]
    vectors = embedder.embed(told)
    again = embedder.embed([*told, description(relation="none")])
    assert [len(texts) for texts in server.embedded] == [2, 1]
    assert vectors.shape == (3, 26)
    assert np.linalg.norm(vectors, axis=1) == pytest.approx(np.ones(3), abs=1e-6)
    assert np.array_equal(vectors[0], vectors[2])
    assert np.array_equal(again[:3], vectors)
    assert embedder.embed([]).shape == (0, 26)
    assert server.embedded[0][0] == told[0].text


@pytest.mark.parametrize("plan", [[500], [429, 503]])
def test_what_passes_is_tried_again(plan: list[int], server: Loopback) -> None:
    server.embedding_plan = list(plan)
    assert len(model(server).embed(["a scene"])[0]) == 26
    assert server.embedding_plan == []


def test_what_does_not_pass_is_said_with_what_to_check(server: Loopback) -> None:
    server.embedding_plan = [500] * 9
    with pytest.raises(ModelUnavailableError, match=r"some-embedder: http://127\.0\.0\.1"):
        model(server).embed(["a scene"])
    assert len(server.embedding_plan) == 9 - ATTEMPTS
    server.embedding_plan = [404]
    with pytest.raises(ModelError, match=r"some-embedder cannot be used: .* check memory\.embedding_model"):
        model(server).embed(["a scene"])


def test_the_key_comes_from_the_environment_and_is_in_no_message(
    server: Loopback, monkeypatch: pytest.MonkeyPatch
) -> None:
    server.key = SECRET
    monkeypatch.delenv(KEY, raising=False)
    with pytest.raises(ModelError, match=f"{KEY} is not set"):
        model(server, KEY).embed(["a scene"])
    monkeypatch.setenv(KEY, SECRET)
    assert model(server, KEY).embed(["a scene"])
    server.embedding_plan = [401]
    with pytest.raises(ModelError) as said:
        model(server, KEY).embed(["another scene"])
    assert SECRET not in str(said.value)


def test_without_an_address_there_has_to_be_a_key() -> None:
    with pytest.raises(ModelError, match=r"memory\.embedding_api_base must be the address"):
        EmbeddingModel("some-embedder", None, None, 1.0).embed(["a scene"])


def test_a_memory_made_with_a_model_is_recalled_from_with_that_model(server: Loopback, tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    settings = {"embedder": "litellm", "embedding_api_base": server.url, "embedding_key_env": None}
    learner = online(path, embedding_model="some-embedder", **settings)
    learner.begin(interaction())
    learner.learn([experience(description(dttcp=0.5)), experience(description(dttcp=7.0), step=5)])
    assert frozen(path, embedding_model="some-embedder", **settings).label.endswith("1 interactions")
    for other in ({"embedder": "features"}, {**settings, "embedding_model": "another"}):
        with pytest.raises(MemoryFileError, match=r"made with the embedder litellm some-embedder"):
            frozen(path, **other)
