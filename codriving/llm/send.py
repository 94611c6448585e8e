"""The only place that knows LiteLLM: one request out, one reply in, and nothing decided."""

import asyncio
import logging
import os
from collections.abc import AsyncIterator, Callable
from dataclasses import asdict
from types import ModuleType
from typing import Any, cast
from urllib.request import getproxies

import httpx

from codriving.llm.faults import fault_of, without_key
from codriving.llm.loop import loop
from codriving.llm.parsing import clean
from codriving.llm.request import ChatRequest, Reply, response_format, worded

# Sent where no key is named; without it LiteLLM would take one from the environment and give it to a stranger.
NO_KEY = "none"

_COMPATIBLE = "openai"  # LiteLLM's word for a server that speaks OpenAI's protocol


class Sender:
    """Sends through LiteLLM, over connections that the whole process shares."""

    async def load(self) -> None:
        """Import LiteLLM, which takes seconds the first time, so that no deadline runs meanwhile."""
        await load_litellm()

    async def send(self, request: ChatRequest, form: str, key: str | None, deadline: float) -> Reply:
        """Send a request once."""
        optional = {"temperature": request.temperature, "response_format": response_format(form, request.schema)}
        try:
            response = await _loaded[0].acompletion(
                model=request.model,
                custom_llm_provider=provider_of(request.model, request.api_base),
                messages=[asdict(message) for message in worded(request.messages, form, request.schema)],
                api_base=request.api_base,
                api_key=key or NO_KEY,
                timeout=deadline,
                max_retries=0,
                num_retries=0,
                stream=False,
                max_tokens=request.max_tokens,
                **{name: value for name, value in optional.items() if value is not None},
            )
            return _reply(response, form, key)
        except Exception as err:
            fault = fault_of(err, key)
        # Outside the handler: LiteLLM's exception, which may quote the key, is not dragged along as context.
        raise fault


_loaded: list[Any] = []
_loading = asyncio.Lock()


async def load_litellm() -> ModuleType:
    """Import LiteLLM and what it imports in its first call, which takes seconds; only the first time."""
    async with _loading:
        if not _loaded:
            _loaded.append(await _import())
    return cast(ModuleType, _loaded[0])


async def _import() -> ModuleType:
    """Import LiteLLM, make it keep quiet, and give it one way of sending for all providers."""
    os.environ.setdefault("LITELLM_LOCAL_MODEL_COST_MAP", "True")
    import litellm
    import openai

    litellm.suppress_debug_info = True
    litellm.telemetry = False
    # For embeddings a 0 of the call counts as nothing said; retries have one owner.
    litellm.DEFAULT_MAX_RETRIES = 0  # type: ignore[attr-defined]
    for name in ("LiteLLM", "httpx", "openai"):
        # Their lines may hold addresses with keys; what goes wrong is told by us.
        logging.getLogger(name).setLevel(logging.CRITICAL)
    litellm.disable_aiohttp_transport = True
    session = client()
    litellm.aclient_session = session
    loop().at_close(session.aclose)
    # Nothing is sent: LiteLLM makes the reply up. It does so only if that is not empty.
    await litellm.acompletion(
        model=f"{_COMPATIBLE}/none",
        messages=[{"role": "user", "content": "Answer with the one word: yes"}],
        api_base="http://127.0.0.1:9",
        api_key=NO_KEY,
        mock_response="yes",
    )
    openai.AsyncOpenAI(api_key=NO_KEY, http_client=session).chat.completions  # noqa: B018 - imports it
    return litellm


def provider_of(model: str, api_base: str | None) -> str | None:
    """Name the protocol where a server of one's own is given and the model's name does not say it."""
    if api_base is None:
        return None
    try:
        _loaded[0].get_llm_provider(model=model)
    except Exception:
        return _COMPATIBLE
    return None


def _reply(response: Any, form: str, key: str | None) -> Reply:  # noqa: ANN401 - LiteLLM's response has no narrow type
    """Normalise a response: any text that is there, and why it ends."""
    usage = getattr(response, "usage", None)
    names = ("prompt_tokens", "completion_tokens")
    tokens: dict[str, Any] = {name: max(0, int(getattr(usage, name, None) or 0)) for name in names}
    choices = getattr(response, "choices", None) or ()
    if not choices:
        return Reply("", "", form=form, **tokens)
    message = choices[0].message
    beside = getattr(message, "provider_specific_fields", None) or {}
    return Reply(
        text=clean(without_key(_text(getattr(message, "content", None)), key)),
        finish_reason=str(choices[0].finish_reason or ""),
        refusal=clean(without_key(str(getattr(message, "refusal", None) or beside.get("refusal") or ""), key)),
        form=form,
        **tokens,
    )


def _text(content: object) -> str:
    """Return the text of a message, whose content may come in parts."""
    if isinstance(content, list):
        return "".join(str(part.get("text") or "") for part in content if isinstance(part, dict))
    return content if isinstance(content, str) else ""


def client() -> httpx.AsyncClient:
    """Return a client for any number of requests at once; it has to be closed."""
    if getproxies():
        # Which proxy leads where is worked out by the client itself, and only for transports of its own.
        limits = httpx.Limits(max_connections=None, max_keepalive_connections=100)
        return httpx.AsyncClient(limits=limits, follow_redirects=True)
    certificates = httpx.create_ssl_context()
    transport = Connections(lambda: httpx.AsyncHTTPTransport(verify=certificates))
    return httpx.AsyncClient(transport=transport, follow_redirects=True)


class Connections(httpx.AsyncBaseTransport):
    """A transport for each request under way; one that is free again is used first by the next request.

    A single transport asks the operating system about every idle connection whenever a request begins and ends. With
    20 episodes side by side that takes longer than all the rest.
    """

    def __init__(self, make: Callable[[], httpx.AsyncBaseTransport]) -> None:
        self._make = make
        self._every: list[httpx.AsyncBaseTransport] = []
        self._free: list[httpx.AsyncBaseTransport] = []

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        """Send a request; its transport is free again when the response is closed."""
        if not self._free:
            self._every.append(self._make())
        transport = self._free.pop() if self._free else self._every[-1]
        try:
            response = await transport.handle_async_request(request)
        except BaseException:
            self._free.append(transport)
            raise
        assert isinstance(response.stream, httpx.AsyncByteStream)
        response.stream = _Closing(response.stream, lambda: self._free.append(transport))
        return response

    async def aclose(self) -> None:
        """Close all connections."""
        for transport in self._every:
            await transport.aclose()


class _Closing(httpx.AsyncByteStream):
    """A stream that says, once, that it is closed."""

    def __init__(self, stream: httpx.AsyncByteStream, closed: Callable[[], None]) -> None:
        self._stream, self._closed = stream, closed

    async def __aiter__(self) -> AsyncIterator[bytes]:
        async for part in self._stream:
            yield part

    async def aclose(self) -> None:
        closed, self._closed = self._closed, lambda: None
        try:
            await self._stream.aclose()
        finally:
            closed()
