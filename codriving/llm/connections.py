"""Connections to servers: one client for all providers, which goes to no other origin and reads to a limit."""

import json
import zlib
from collections.abc import AsyncIterator, Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any
from urllib.request import getproxies

import httpx

from codriving.llm.events import completion_of
from codriving.llm.faults import LOOPBACK, PROXIES, CallError, FaultKind, fault_of_response, refusal_within, set_of
from codriving.llm.request import LIMIT

LARGEST = 2_000_000  # More of a response is not read, counted when it is unpacked [bytes]

_PER_OBJECT = 400  # Of the bytes of a response for each object or list in it; an answer has a dozen

_HOPS = 3  # How often a redirect within one origin is followed

_PIECE = 65_536  # What is unpacked at once at most [bytes]

_largest: ContextVar[int] = ContextVar("largest", default=LARGEST)

_bodies: ContextVar[list[bytes] | None] = ContextVar("bodies", default=None)


def keep_bodies() -> list[bytes]:
    """Return a list into which the bodies of the responses to this task go, as the server sent them."""
    kept: list[bytes] = []
    _bodies.set(kept)
    return kept


@contextmanager
def at_most(size: int) -> Iterator[None]:
    """Take responses of another size in this task."""
    token = _largest.set(size)
    try:
        yield
    finally:
        _largest.reset(token)


@dataclass(frozen=True, slots=True)
class Outgoing:
    """What becomes of the requests of a task, whatever its provider's library makes of them."""

    fields: Mapping[str, Any] = field(default_factory=dict)  # Of the body, at any depth; None takes one out
    headers: Mapping[str, str] = field(default_factory=dict)
    limit: str | None = LIMIT  # What the longest answer is called; None sends none
    key_header: str | None = None  # Header that carries the key in the place of the provider's own

    def apply(self, request: httpx.Request, content: bytes) -> httpx.Request:
        """Change a request."""
        body = json.loads(content)
        if self.limit != LIMIT:
            found = [body.pop(name) for name in (LIMIT, "max_completion_tokens") if name in body]
            body |= {self.limit: found[0]} if found and self.limit else {}
        merge(body, self.fields)
        headers = request.headers.copy()
        del headers["content-length"]
        for name in ("authorization", "x-api-key", "x-goog-api-key", "api-key") if self.key_header else ():
            headers.pop(name, None)
        headers.update(dict(self.headers))
        text = json.dumps(body, ensure_ascii=False, separators=(",", ":")).encode()
        return httpx.Request(request.method, request.url, headers=headers, content=text, extensions=request.extensions)


def merge(body: dict[str, Any], fields: Mapping[str, Any]) -> None:
    """Put fields into a body; objects are merged, None takes a field out."""
    for name, value in fields.items():
        if isinstance(value, Mapping) and isinstance(body.get(name), dict):
            merge(body[name], value)
        elif value is None:
            body.pop(name, None)
        else:
            body[name] = value


_outgoing: ContextVar[Outgoing | None] = ContextVar("outgoing", default=None)


@contextmanager
def changed(outgoing: Outgoing) -> Iterator[None]:
    """Change what this task sends."""
    token = _outgoing.set(outgoing if outgoing != Outgoing() else None)
    try:
        yield
    finally:
        _outgoing.reset(token)


def client(**settings: Any) -> httpx.AsyncClient:  # noqa: ANN401 - settings of httpx
    """Return a client for any number of requests at once; it has to be closed."""
    try:
        certificates = httpx.create_ssl_context()
    except OSError:
        names = " or ".join(set_of("SSL_CERT_FILE", "SSL_CERT_DIR")) or "its folder of certificates"
        plain = Connections(lambda: httpx.AsyncHTTPTransport(verify=False))  # Never for https, which is refused
        mounts = {"https://": _Refusing(f"{names} names no certificates that can be read"), **_here("http", plain)}
        return Client(transport=plain, mounts=mounts, trust_env=False, **settings)
    transport = Connections(lambda: httpx.AsyncHTTPTransport(verify=certificates))
    if not getproxies():
        return Client(transport=transport, **settings)
    limits = httpx.Limits(max_connections=None, max_keepalive_connections=100)
    try:
        # Which proxy leads where is worked out by the client itself, but for this machine: no proxy leads there.
        return Client(limits=limits, mounts=_here("all", transport), **settings)
    except (ImportError, ValueError, TypeError, httpx.InvalidURL) as error:
        names = " or ".join(set_of(*PROXIES))
        why = "socks needs pip install 'httpx[socks]'" if isinstance(error, ImportError) else "no address of a proxy"
        refusing = _Refusing(f"{names} cannot be used: {why}")
        return Client(transport=refusing, mounts=_here("all", transport), trust_env=False, **settings)


def _here(scheme: str, transport: httpx.AsyncBaseTransport) -> dict[str, httpx.AsyncBaseTransport]:
    return {f"{scheme}://{host}": transport for host in LOOPBACK}


class _Refusing(httpx.AsyncBaseTransport):
    """In the place of a transport that the variables of other programs make impossible."""

    def __init__(self, why: str) -> None:
        self._why = why

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        """Refuse a request."""
        raise CallError(FaultKind.VARIABLE, self._why)


class Client(httpx.AsyncClient):
    """Sends to one origin: what is sent may hold a key and always holds prompts, which belong to the server named.

    Whatever a server refuses with is told here, where status, headers and body are at hand.
    """

    async def send(self, request: httpx.Request, *, stream: bool = False, **others: Any) -> httpx.Response:  # noqa: ANN401
        """See ``httpx``."""
        # Nothing is gained by packing a thousand characters, and a packed body may open to any size.
        request.headers["accept-encoding"] = "identity"
        if outgoing := _outgoing.get():
            request = outgoing.apply(request, await request.aread())
        others |= {"stream": True, "follow_redirects": False}
        response = await super().send(request, **others)
        for _ in range(_HOPS):
            if response.status_code not in (307, 308) or not _within(response):
                break
            await response.aclose()
            assert response.next_request is not None
            response = await super().send(response.next_request, **others)
        try:
            if 300 <= response.status_code < 400:
                raise CallError(FaultKind.REDIRECT, f"{response.status_code} to {_target(response)}")
            _cap(response)
            if response.status_code >= 400:
                await response.aread()
                raise fault_of_response(response.status_code, response.headers, response.text)
            if not stream:
                _refuse_many(await response.aread())
                if response.headers.get("content-type", "").startswith("text/event-stream"):
                    response = _at_once(response, await response.aread())
                if (bodies := _bodies.get()) is not None:
                    bodies.append(await response.aread())
                if refused := refusal_within(await response.aread()):
                    raise refused
        except BaseException:
            await response.aclose()
            raise
        return response


def _refuse_many(body: bytes) -> None:
    """Refuse what is short but holds so many objects that LiteLLM would be busy with them for minutes."""
    most = _largest.get() // _PER_OBJECT
    if body.count(b"{") + body.count(b"[") > most:
        raise CallError(FaultKind.OVERSIZE, f"more than {most} objects")


def _at_once(response: httpx.Response, events: bytes) -> httpx.Response:
    """Turn events into the response that would have been sent at once."""
    body = completion_of(events.decode("utf-8", "replace"))
    return httpx.Response(200, headers={"content-type": "application/json"}, content=body, request=response.request)


def _origin(url: httpx.URL) -> tuple[str, str, int | None]:
    return url.scheme, url.host, url.port


def _within(response: httpx.Response) -> bool:
    following = response.next_request
    return following is not None and _origin(following.url) == _origin(response.request.url)


def _target(response: httpx.Response) -> str:
    """Where a redirect leads, without what an address may carry."""
    with suppress(httpx.InvalidURL):
        if to := response.headers.get("location"):
            return str(response.url.join(to).copy_with(userinfo=b"", query=None, fragment=None))
    return "an address that is none"


def _cap(response: httpx.Response) -> None:
    """Unpack a body no further than is wanted of it."""
    packed = response.headers.pop("content-encoding", "identity").strip().lower()
    if packed not in ("identity", "", "gzip", "x-gzip", "deflate"):
        raise CallError(FaultKind.OVERSIZE, f"packed as {packed[:20]}, which was not asked for")
    assert isinstance(response.stream, httpx.AsyncByteStream)
    response.stream = _Capped(response.stream, None if packed in ("identity", "") else packed, _largest.get())


class _Capped(httpx.AsyncByteStream):
    """A body that is unpacked bit by bit and ends with an error where it becomes too long."""

    def __init__(self, stream: httpx.AsyncByteStream, packed: str | None, largest: int) -> None:
        self._stream, self._packed, self._left, self._largest = stream, packed, largest, largest

    async def __aiter__(self) -> AsyncIterator[bytes]:
        unpacker: Any = None
        async for part in self._stream:
            if self._packed and unpacker is None:
                # Some send deflate without the two bytes that zlib puts before it.
                bare = self._packed == "deflate" and part[:1] != b"\x78"
                # 47: gzip and zlib are told by their first bytes.
                unpacker = zlib.decompressobj(-15 if bare else 47)
            while part:
                piece, part = _unpacked(unpacker, part) if unpacker else (part, b"")
                self._left -= len(piece)
                if self._left < 0:
                    raise CallError(FaultKind.OVERSIZE, f"more than {self._largest / 1e6:g} MB")
                if piece:
                    yield piece

    async def aclose(self) -> None:
        await self._stream.aclose()


def _unpacked(unpacker: Any, part: bytes) -> tuple[bytes, bytes]:  # noqa: ANN401 - zlib does not name its type
    """Unpack a piece; gives it and what is left to unpack."""
    try:
        piece = unpacker.decompress(part, _PIECE)
    except zlib.error as error:
        raise CallError(FaultKind.UNREADABLE, "a body that cannot be unpacked") from error
    return piece, b"" if unpacker.eof else unpacker.unconsumed_tail


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
