"""Connections: as many as there are requests under way, and free again whatever becomes of a request."""

import asyncio
from collections.abc import AsyncIterator

import httpx
import pytest

from codriving.llm import connections
from codriving.llm.connections import Connections


class Parts(httpx.AsyncByteStream):
    """A body that is read bit by bit."""

    async def __aiter__(self) -> AsyncIterator[bytes]:
        yield b"yes"


class Fake(httpx.AsyncBaseTransport):
    """Answers when it may, or fails."""

    def __init__(self, go: asyncio.Event) -> None:
        self.go, self.sent, self.closed = go, 0, False

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        """See ``httpx``."""
        self.sent += 1
        await self.go.wait()
        if request.url.path == "/broken":
            raise httpx.ConnectError("no")
        return httpx.Response(200, stream=Parts())

    async def aclose(self) -> None:
        """See ``httpx``."""
        self.closed = True


def pool() -> tuple[list[Fake], Connections, asyncio.Event]:
    made: list[Fake] = []
    go = asyncio.Event()

    def make() -> Fake:
        made.append(Fake(go))
        return made[-1]

    return made, Connections(make), go


def test_each_request_under_way_has_one_and_the_next_takes_the_last() -> None:
    async def ask() -> None:
        made, transport, go = pool()
        async with httpx.AsyncClient(transport=transport) as client:
            under_way = [asyncio.create_task(client.get("http://here/")) for _ in range(3)]
            await asyncio.sleep(0)
            go.set()
            assert [(await one).text for one in under_way] == ["yes"] * 3
            for _ in range(5):
                await client.get("http://here/")
            assert [fake.sent for fake in made] == [1, 1, 6]
        assert all(fake.closed for fake in made)

    asyncio.run(ask())


def test_free_again_after_a_failure_and_after_giving_up() -> None:
    async def ask() -> None:
        made, transport, go = pool()
        async with httpx.AsyncClient(transport=transport) as client:
            with pytest.raises(TimeoutError):
                async with asyncio.timeout(0):
                    await client.get("http://here/")
            go.set()
            with pytest.raises(httpx.ConnectError):
                await client.get("http://here/broken")
            async with client.stream("GET", "http://here/") as response:
                assert response.status_code == 200
            await response.aclose()
            await client.get("http://here/")
            assert [fake.sent for fake in made] == [4]

    asyncio.run(ask())


def test_a_proxy_leads_everywhere_but_to_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HTTPS_PROXY", "http://127.0.0.1:9")

    async def transports() -> list[type]:
        async with connections.client() as session:
            urls = ["https://example.org", "https://127.0.0.1:1", "http://localhost", "http://[::1]:8000/v1"]
            return [type(session._transport_for_url(httpx.URL(url))) for url in urls]

    assert asyncio.run(transports()) == [httpx.AsyncHTTPTransport, Connections, Connections, Connections]
