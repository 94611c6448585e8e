"""Variables that other programs set: no proxy leads to this machine, and what cannot be used is named."""

import asyncio
from typing import Any

import pytest
from loopback import Loopback
from typer.testing import CliRunner

from codriving.cli.app import app
from codriving.llm.connections import client
from codriving.llm.faults import CallError, _by_proxy

ALL = ("HTTP_PROXY", "HTTPS_PROXY", "ALL_PROXY", "NO_PROXY", "SSL_CERT_FILE", "SSL_CERT_DIR")


@pytest.fixture(autouse=True)
def none_set(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ALL:
        monkeypatch.delenv(name, raising=False)
        monkeypatch.delenv(name.lower(), raising=False)


ODD: tuple[dict[str, str], ...] = (
    {"ALL_PROXY": "socks5://127.0.0.1:9"},
    {"HTTP_PROXY": "http://127.0.0.1:9"},
    {"HTTP_PROXY": "::", "NO_PROXY": "[::"},
    {"http_proxy": "ftp://x"},
    {"SSL_CERT_FILE": "/nowhere.pem"},
    {"SSL_CERT_FILE": "/dev/null", "ALL_PROXY": "socks5://127.0.0.1:9"},
)


@pytest.mark.parametrize("variables", ODD)
def test_a_server_on_this_machine_is_reached_whatever_is_set(
    variables: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in variables.items():
        monkeypatch.setenv(name, value)

    async def ask(address: str) -> Any:
        async with client() as session:
            body = {"model": "any", "messages": [{"role": "user", "content": "Answer with the one word: yes"}]}
            return (await session.post(f"{address}/chat/completions", json=body)).status_code

    with Loopback() as server:
        for address in (server.url, server.url.replace("127.0.0.1", "localhost")):
            assert asyncio.run(ask(address)) == 200


@pytest.mark.parametrize(
    ("variables", "said"),
    [
        ({"ALL_PROXY": "socks5://127.0.0.1:9"}, "ALL_PROXY cannot be used: socks needs pip install 'httpx[socks]'"),
        ({"https_proxy": "::"}, "https_proxy cannot be used: no address of a proxy"),
        ({"SSL_CERT_FILE": "/nowhere.pem"}, "SSL_CERT_FILE names no certificates that can be read"),
    ],
)
def test_what_cannot_be_used_is_named(variables: dict[str, str], said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in variables.items():
        monkeypatch.setenv(name, value)

    async def ask() -> None:
        async with client() as session:
            await session.get("https://198.51.100.1/v1")

    with pytest.raises(CallError, match="cannot be asked") as caught:
        asyncio.run(ask())
    assert caught.value.detail == said


def test_the_proxy_is_named_where_a_server_elsewhere_is_not_reached(monkeypatch: pytest.MonkeyPatch) -> None:
    class Settings:
        api_base = "http://198.51.100.1/v1"

    monkeypatch.setenv("HTTP_PROXY", "http://127.0.0.1:9")
    assert _by_proxy(Settings()) == " or the proxy of HTTP_PROXY (unset to ask directly)"  # type: ignore[arg-type]
    Settings.api_base = "http://127.0.0.1:8000/v1"
    assert _by_proxy(Settings()) == ""  # type: ignore[arg-type]


@pytest.mark.parametrize("address", ["http://127.0.0.1:99999/v1", "http://127.0.0.1:x/v1"])
def test_an_address_with_a_port_that_is_none_is_refused(address: str) -> None:
    result = CliRunner().invoke(app, ["check", "llm=custom", f"llm.api_base={address}"])
    assert result.exit_code == 2
    assert result.stderr.startswith("error: llm.api_base must be an address such as http://127.0.0.1:8000/v1, got what")
