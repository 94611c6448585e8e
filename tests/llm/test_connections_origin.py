"""What is sent stays with the server that was named, and what it sends back is read to a limit, over HTTP."""

import gzip
import time
import zlib
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from fake_sender import SETTINGS, Choice, Waits
from faults import FAULTS, Fault, moved
from loopback import Loopback

from codriving.errors import ModelError, ModelUnavailableError
from codriving.llm.client import ModelChat
from codriving.llm.embeddings import EmbeddingModel
from codriving.llm.question import Message, Question
from codriving.llm.request import Forms

KEY = "sk-canary-0123456789abcdef"
QUESTION = Question(
    "decide", "cav_0", (Message("system", "You drive."), Message("user", "Allowed actions: IDLE, SLOWER\n")), Choice
)
PATHS = {
    "openai/m": "/chat/completions",
    "hosted_vllm/m": "/chat/completions",
    "ollama_chat/m": "/api/chat",
    "anthropic/m": "/v1/messages",
    "gemini/m": ":generateContent",
}


@pytest.fixture(autouse=True)
def key(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CANARY_KEY", KEY)
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")


def client(server: Loopback, **changes: Any) -> ModelChat:
    settings = {"model": "openai/m", "api_base": server.url, "api_key_env": "CANARY_KEY", "attempts": 2, **changes}
    return ModelChat(replace(SETTINGS, **settings), sleep=Waits(), forms=Forms())


@pytest.mark.parametrize("status", [300, 301, 302, 303, 307, 308])
@pytest.mark.parametrize("model", PATHS)
def test_no_redirect_to_another_origin_is_followed(serve: Callable[..., Loopback], model: str, status: int) -> None:
    other, server = serve(), serve()
    server.elsewhere = [moved(status, f"{other.url}{PATHS[model]}?key={KEY}")] * 9
    server.plan = list(server.elsewhere)
    with pytest.raises(ModelError) as refusal:
        client(server, model=model).preflight()
    assert f"redirects ({status} to {other.url}" in str(refusal.value)
    assert "set llm.api_base to that address" in str(refusal.value)
    assert "\n" not in str(refusal.value)
    assert KEY not in str(refusal.value)
    assert other.connections == 0


@pytest.mark.parametrize(
    "to", ["https://127.0.0.1:{port}/v1/chat/completions", "http://localhost:{port}/v1/chat/completions"]
)
def test_another_scheme_or_name_is_another_origin(loopback: Loopback, to: str) -> None:
    loopback.plan = [moved(307, to.format(port=loopback.port))] * 9
    with pytest.raises(ModelError, match=r"redirects \(307 to "):
        client(loopback).preflight()
    assert len(loopback.requests) == 1


def test_a_chain_is_followed_within_the_origin_and_ends_at_its_border(serve: Callable[..., Loopback]) -> None:
    other, server = serve(), serve()
    inside = moved(308, "/v1/chat/completions")
    server.plan = [inside, moved(307, f"{server.url}/chat/completions")]
    assert client(server).ask([QUESTION])[0].value is not None
    server.restart_plan([inside, moved(302, f"{other.url}/chat/completions")])
    with pytest.raises(ModelError, match=f"302 to {other.url}"):
        client(server).ask([QUESTION])
    server.restart_plan([inside] * 99)
    with pytest.raises(ModelError, match="redirects"):
        client(server).ask([QUESTION])
    assert other.connections == 0


def test_a_redirect_in_the_middle_ends_the_episode(serve: Callable[..., Loopback]) -> None:
    other, server = serve(), serve()
    asked = client(server)
    asked.preflight()
    server.restart_plan([moved(307, f"{other.url}/chat/completions")] * 9)
    with pytest.raises(ModelUnavailableError, match=r"redirects .* asked once"):
        asked.ask([QUESTION])
    assert other.connections == 0


@pytest.mark.parametrize("status", [301, 307])
def test_texts_for_an_embedding_model_stay_with_their_server(serve: Callable[..., Loopback], status: int) -> None:
    other, server = serve(), serve()
    server.embedding_plan = [moved(status, f"{other.url}/embeddings")] * 9
    with pytest.raises(ModelError, match=rf"redirects \({status} to .*memory\.embedding_api_base"):
        EmbeddingModel("some-embedder", server.url, "CANARY_KEY", 10.0).embed(["a scene"])
    assert other.connections == 0


def packed(encoding: str, pack: Callable[[bytes], bytes], **changes: Any) -> Fault:
    return Fault(headers={"Content-Encoding": encoding}, pack=pack, **changes)


def bare(body: bytes) -> bytes:
    packer = zlib.compressobj(wbits=-15)
    return packer.compress(body) + packer.flush()


@pytest.mark.parametrize(("encoding", "pack"), [("gzip", gzip.compress), ("deflate", zlib.compress), ("deflate", bare)])
def test_a_packed_answer_is_read_although_none_is_asked_for(
    loopback: Loopback, encoding: str, pack: Callable[[bytes], bytes]
) -> None:
    loopback.plan = [packed(encoding, pack)]
    assert client(loopback).ask([QUESTION])[0].value is not None
    assert loopback.requests[0].headers["accept-encoding"] == "identity"


LARGE = b'{"choices": [{"message": {"content": "' + b"a" * 50_000_000 + b'"}}]}'

BOMBS = {
    "gzip": packed("gzip", lambda body: gzip.compress(LARGE)),
    "gzip of an error": packed("gzip", lambda body: gzip.compress(LARGE), status=500, error="no"),
    "deflate": packed("deflate", lambda body: zlib.compress(LARGE)),
    "bare deflate": packed("deflate", lambda body: bare(LARGE)),
    "plain": Fault(pack=lambda body: LARGE),
    "endless": Fault(endless=b"a" * 60_000),
    "twice": packed("gzip, gzip", lambda body: gzip.compress(gzip.compress(LARGE))),
    "many choices": Fault(pack=lambda body: b'{"choices": [' + b"{}, " * 400_000 + b"{}]}"),
    "many lists": Fault(pack=lambda body: b"[" * 1_000_000),
    "br": packed("br", lambda body: b"\x5b" * 1000),
    "zstd": packed("zstd", lambda body: b"\x28\xb5\x2f\xfd" * 1000),
}


@pytest.mark.parametrize("name", BOMBS)
def test_a_body_is_read_to_a_limit_and_the_other_questions_go_on(loopback: Loopback, name: str) -> None:
    asked = client(loopback)
    asked.preflight()
    loopback.restart_plan([BOMBS[name]])
    begun = time.perf_counter()
    with pytest.raises(
        ModelUnavailableError,
        match=r"sent more than an answer can be \((more than 2 MB|more than 5000 objects|packed as)",
    ) as failure:
        asked.ask([QUESTION])
    assert "\n" not in str(failure.value)
    assert asked.ask([QUESTION])[0].value is not None
    assert time.perf_counter() - begun < 5


@pytest.mark.parametrize(("encoding", "body"), [("gzip", b"no gzip at all"), ("deflate", b"\x78no"), ("gzip", b"")])
def test_a_body_that_cannot_be_unpacked_is_no_answer(loopback: Loopback, encoding: str, body: bytes) -> None:
    asked = client(loopback)
    asked.preflight()
    loopback.restart_plan([packed(encoding, lambda _: body)])
    answer = asked.ask([QUESTION])[0]
    assert answer.value is not None
    assert len(answer.calls) == 2


def test_a_header_without_end_takes_no_episode_down(loopback: Loopback) -> None:
    asked = client(loopback)
    asked.preflight()
    loopback.restart_plan([Fault(headers={"X-Long": "a" * 1_000_000})])
    assert asked.ask([QUESTION])[0].value is not None


def test_vectors_of_many_texts_are_not_too_large(loopback: Loopback) -> None:
    texts = [f"scene {k}" for k in range(20_000)]
    assert len(EmbeddingModel("some-embedder", loopback.url, None, 30.0).embed(texts)) == 20_000
    loopback.embedding_plan = [Fault(pack=lambda body: LARGE)]
    with pytest.raises(ModelError, match=r"more than 2\.2 MB"):
        EmbeddingModel("some-embedder", loopback.url, None, 30.0).embed(["a scene"])


def test_no_error_body_hides_behind_status_200(loopback: Loopback) -> None:
    asked = client(loopback)
    asked.preflight()
    loopback.restart_plan([Fault(wrap=lambda body: {"error": {"message": "slow down", "code": 429}})])
    assert asked.ask([QUESTION])[0].calls[0].attempts == 2
    assert FAULTS["ok"].status == 200
