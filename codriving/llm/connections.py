"""Connections to servers: as many as there are requests under way, each found without looking at the others."""

from collections.abc import AsyncIterator, Callable
from urllib.request import getproxies

import httpx


def client() -> httpx.AsyncClient:
    """Return a client for any number of requests at once; it has to be closed."""
    if getproxies():
        # Which proxy leads where is worked out by the client itself, and only for transports of its own.
        limits = httpx.Limits(max_connections=None, max_keepalive_connections=100)
        return httpx.AsyncClient(limits=limits, follow_redirects=True)
    certificates = httpx.create_ssl_context()
    return httpx.AsyncClient(
        transport=Connections(lambda: httpx.AsyncHTTPTransport(verify=certificates)), follow_redirects=True
    )


class Connections(httpx.AsyncBaseTransport):
    """A transport for each request under way; one that is free again is used first by whoever comes next.

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
