"""An OpenAI-compatible server on this machine's loopback address, which answers from the prompt alone.

Run it by hand with ``python tests/llm/loopback.py --port 0``; it prints its port and serves until it is interrupted.
"""

import argparse
import asyncio
import json
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any

from faults import FAULTS, Fault, no_such_form, too_long
from reading import answer, read, schema_of

FORMS = ("json_schema", "json_object", "text")

HANDSHAKE = 10.0
"""How long starting and closing may take [s]."""


@dataclass(frozen=True)
class Request:
    """One request that arrived.

    Attributes:
        number: Which one, from 0.
        method: ``GET`` or ``POST``.
        path: What it asked for.
        headers: Its headers, names in lower case.
        text: Its body as it came.
        body: Its body as JSON; empty if there is none.
    """

    number: int
    method: str
    path: str
    headers: dict[str, str]
    text: str
    body: dict[str, Any]

    @property
    def form(self) -> str:
        """How the answer is asked for."""
        return str((self.body.get("response_format") or {}).get("type", "text"))

    @property
    def messages(self) -> list[dict[str, Any]]:
        """The conversation."""
        return list(self.body.get("messages", ()))

    @property
    def length(self) -> int:
        """Length of the conversation [characters]."""
        return sum(len(str(message.get("content") or "")) for message in self.messages)


Plan = Sequence[str | Fault] | Callable[[Request], str | Fault | None]
"""What goes wrong: with the first request, the second and so on (then nothing), or a function of the request."""


class Loopback:
    """Serves chat completions while the ``with`` block lasts.

    Args:
        plan: What goes wrong; may be replaced at any time by assigning to ``plan``.
        latency: How long every answer takes [s].
        forms: Forms of answer that are supported; any other is refused with 400.
        context: Longest conversation that is taken [characters]; None takes any.
        models: Models that exist; None lets every model exist.
        key: Key that has to be sent; None takes any and none.
        port: Port to serve at; 0 takes a free one.

    Attributes:
        embedding_plan: Status of the next answers to requests for vectors, or what goes wrong; 200 once it is used up.
        elsewhere: What goes wrong with the next requests for anything else.
        embedded: The texts of each such request that was answered.
        requests: The requests for an answer, in order of arrival; others are in ``others``.
        in_flight: How many are being answered now.
        high_water: How many were being answered at once at most.
        connections: How many connections were opened.
    """

    def __init__(
        self,
        plan: Plan = (),
        *,
        latency: float = 0.0,
        forms: Sequence[str] = FORMS,
        context: int | None = None,
        models: Sequence[str] | None = None,
        key: str | None = None,
        port: int = 0,
    ) -> None:
        self.plan, self.latency, self.forms, self.context = plan, latency, tuple(forms), context
        self.models, self.key, self.port = models, key, port
        self.requests: list[Request] = []
        self.others: list[Request] = []
        self.in_flight = self.high_water = self.connections = 0
        self.embedding_plan: list[int | Fault] = []
        self.elsewhere: list[Fault] = []
        self.embedded: list[list[str]] = []
        self._begun = 0
        self._ready, self._ended = threading.Event(), asyncio.Event()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread = threading.Thread(target=lambda: asyncio.run(self._serve()), name="loopback", daemon=True)
        self._broken: BaseException | None = None

    @property
    def url(self) -> str:
        """What to set ``llm.api_base`` to."""
        return f"http://127.0.0.1:{self.port}/v1"

    def __enter__(self) -> "Loopback":
        self._thread.start()
        if not self._ready.wait(HANDSHAKE):
            raise TimeoutError("the server did not start")
        if self._broken:
            raise self._broken
        return self

    def __exit__(self, *args: object) -> None:
        if self._loop is not None and self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._ended.set)
        self._thread.join(HANDSHAKE)

    def restart_plan(self, plan: Plan = ()) -> None:
        """Forget what was requested and follow another plan from its beginning.

        Args:
            plan: What goes wrong from now on.
        """
        self.plan, self._begun = plan, len(self.requests)

    async def _serve(self) -> None:
        self._loop = asyncio.get_running_loop()
        tasks: set[asyncio.Task[None]] = set()

        async def connected(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            task = asyncio.current_task()
            assert task is not None
            tasks.add(task)
            self.connections += 1
            try:
                with suppress(ConnectionError, asyncio.IncompleteReadError):
                    await self._converse(reader, writer)
            except asyncio.CancelledError:
                pass  # the server ends
            finally:
                tasks.discard(task)
                writer.transport.abort()

        try:
            server = await asyncio.start_server(connected, "127.0.0.1", self.port, backlog=512)
        except OSError as error:
            self._broken = error
            self._ready.set()
            return
        self.port = server.sockets[0].getsockname()[1]
        self._ready.set()
        await self._ended.wait()
        server.close()
        for task in list(tasks):
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        # Transports close in the next round of the loop.
        await asyncio.sleep(0)

    async def _converse(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Answer one request after the other on one connection."""
        while (head := (await reader.readuntil(b"\r\n\r\n")).decode("latin-1")) and not self._ended.is_set():
            first, *lines = head.split("\r\n")
            method, path, _ = first.split(" ", 2)
            headers = {
                name.lower(): value.strip() for name, _, value in (line.partition(":") for line in lines if line)
            }
            text = (await reader.readexactly(int(headers.get("content-length", "0")))).decode()
            if not path.endswith("/chat/completions"):
                request = Request(len(self.others), method, path, headers, text, _body(text))
                self.others.append(request)
                fault = self._embedding_fault(request)
                await _send(writer, *self._elsewhere(request, fault.status), fault)
                continue
            request = Request(len(self.requests), method, path, headers, text, _body(text))
            self.requests.append(request)
            self.in_flight += 1
            self.high_water = max(self.high_water, self.in_flight)
            try:
                if not await self._reply(request, self._fault(request), reader, writer):
                    return
            finally:
                self.in_flight -= 1

    def _fault(self, request: Request) -> Fault:
        """What goes wrong with a request: what the server cannot do comes before what is planned."""
        sent = request.headers.get("authorization", "")
        if self.key is not None and sent != f"Bearer {self.key}":
            return FAULTS["401"]
        if self.models is not None and request.body.get("model") not in self.models:
            return FAULTS["404"]
        if request.form not in self.forms:
            return no_such_form(request.form)
        if self.context is not None and request.length > self.context:
            return too_long(self.context, request.length)
        if callable(self.plan):
            planned = self.plan(request) or "ok"
        else:
            turn = request.number - self._begun
            planned = self.plan[turn] if turn < len(self.plan) else "ok"
        fault = planned if isinstance(planned, Fault) else FAULTS[planned]
        return fault if not fault.only_for or request.form in fault.only_for else FAULTS["ok"]

    async def _reply(
        self, request: Request, fault: Fault, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> bool:
        """Answer, or do what goes wrong; whether the connection goes on."""
        if fault.hangs:
            await reader.read(1)  # until the client gives up
            return False
        if fault.drops == "before":
            return False
        if self.latency + fault.latency:
            await asyncio.sleep(self.latency + fault.latency)
        status, kind, text = self._content(request, fault)
        text = text.replace("{authorization}", request.headers.get("authorization", ""))
        return await _send(writer, status, kind, text, fault)

    def _content(self, request: Request, fault: Fault) -> tuple[int, str, str]:
        """Status, type and body of a response."""
        if fault.page:
            return fault.status, "text/html", fault.page
        if fault.error:
            error = {"message": fault.error, "type": fault.code, "param": None, "code": fault.code}
            return fault.status, "application/json", json.dumps({"error": error})
        said = json.dumps(answer(fault.read(read(request.messages)), schema_of(request.body)))
        content = fault.write(said)
        completion = {
            "id": f"chatcmpl-{request.number}",
            "object": "chat.completion",
            "created": 0,
            "model": request.body.get("model", ""),
            "choices": [
                {"index": 0, "finish_reason": "stop", "message": {"role": "assistant", "content": content}},
            ],
            "usage": usage(request.length, len(content or "")),
        }
        completion = fault.wrap(completion)
        if request.body.get("stream"):
            return fault.status, "text/event-stream", streamed(completion)
        return fault.status, "application/json", json.dumps(completion)

    def _embedding_fault(self, request: Request) -> Fault:
        if not request.path.endswith("/embeddings"):
            return self.elsewhere.pop(0) if self.elsewhere else FAULTS["ok"]
        sent = request.headers.get("authorization", "")
        refused = self.key is not None and sent != f"Bearer {self.key}"
        planned = self.embedding_plan.pop(0) if self.embedding_plan else 401 if refused else 200
        return planned if isinstance(planned, Fault) else Fault(status=planned)

    def _elsewhere(self, request: Request, status: int) -> tuple[int, str, str]:
        """The list of models, and vectors of texts; anything else does not exist."""
        if 300 <= status < 400:
            return status, "text/plain", ""
        if request.path.endswith("/embeddings"):
            sent = request.headers.get("authorization", "")
            if status != 200:
                return status, "application/json", json.dumps({"error": {"message": f"refused {sent}"}})
            texts = request.body.get("input", [])
            self.embedded.append(texts)
            data = [{"object": "embedding", "index": k, "embedding": vector(text)} for k, text in enumerate(texts)]
            body = {"object": "list", "data": data, "model": "any", "usage": usage(1, 0)}
            return 200, "application/json", json.dumps(body)
        if request.path.endswith("/models"):
            names = self.models if self.models is not None else ["any"]
            return 200, "application/json", json.dumps({"data": [{"id": name, "object": "model"} for name in names]})
        return 404, "application/json", json.dumps({"error": {"message": f"no {request.path} here"}})


def streamed(completion: dict[str, Any]) -> str:
    """Write a completion as events, its content in two parts.

    Args:
        completion: The body as it would be sent at once.
    """
    choice = completion["choices"][0]
    content, half = choice["message"]["content"], len(choice["message"]["content"]) // 2
    deltas = [({"role": "assistant", "content": content[:half]}, None), ({"content": content[half:]}, "stop")]
    events = [
        {
            **completion,
            "object": "chat.completion.chunk",
            "choices": [{"index": 0, "delta": delta, "finish_reason": end}],
        }
        for delta, end in deltas
    ]
    return "".join(f"data: {json.dumps(event)}\n\n" for event in events) + "data: [DONE]\n\n"


def vector(text: str) -> list[float]:
    """Count the letters of a text, a vector of 26 numbers.

    Args:
        text: Any text.
    """
    return [float(text.lower().count(chr(ord("a") + k))) for k in range(26)]


def usage(asked: int, said: int) -> dict[str, int]:
    """Count tokens, four characters each.

    Args:
        asked: Length of the conversation [characters].
        said: Length of the answer [characters].
    """
    prompt, completion = -(-asked // 4), -(-said // 4)
    return {"prompt_tokens": prompt, "completion_tokens": completion, "total_tokens": prompt + completion}


def _body(text: str) -> dict[str, Any]:
    try:
        value = json.loads(text or "{}")
    except ValueError:
        return {}
    return value if isinstance(value, dict) else {}


async def _send(writer: asyncio.StreamWriter, status: int, kind: str, text: str, fault: Fault = FAULTS["ok"]) -> bool:
    """Send a response; whether the connection goes on."""
    payload = fault.pack(text.encode())
    length = {"Transfer-Encoding": "chunked"} if fault.endless else {"Content-Length": str(len(payload))}
    lines = {"Content-Type": kind, **length, **fault.headers}
    head = "".join(f"{name}: {value}\r\n" for name, value in lines.items())
    whole = f"HTTP/1.1 {status} {HTTPStatus(status).phrase}\r\n{head}\r\n".encode() + payload
    if fault.drops == "within":
        writer.write(whole[: len(whole) - len(payload) // 2])
        await writer.drain()
        return False
    if fault.endless:
        writer.write(whole[: len(whole) - len(payload)])
        chunk = f"{len(fault.endless):x}\r\n".encode() + fault.endless + b"\r\n"
        while not writer.is_closing():
            writer.write(chunk)
            await writer.drain()
        return False
    if fault.trickle:
        for k in range(len(whole)):
            writer.write(whole[k : k + 1])
            await writer.drain()
            await asyncio.sleep(fault.trickle)
    else:
        writer.write(whole)
        await writer.drain()
    return True


def main() -> None:
    """Serve until interrupted."""
    parser = argparse.ArgumentParser(description="A stand-in for a language model that answers from the prompt alone.")
    parser.add_argument("--port", type=int, default=0, help="port to serve at; 0 takes a free one")
    parser.add_argument("--latency", type=float, default=0.0, help="how long every answer takes [s]")
    parser.add_argument("--key", help="key that has to be sent")
    parser.add_argument("--context", type=int, help="longest conversation that is taken [characters]")
    parser.add_argument("--forms", default=",".join(FORMS), help="forms of answer that are supported")
    parser.add_argument("--plan", default="", help=f"what goes wrong, one name a request: {', '.join(FAULTS)}")
    parser.add_argument("--always", choices=FAULTS, help="what goes wrong with every request")
    given = parser.parse_args()
    plan: Plan = [name for name in given.plan.split(",") if name]
    if given.always:
        plan = lambda request: given.always  # noqa: E731
    forms = given.forms.split(",")
    settings: dict[str, Any] = {"latency": given.latency, "forms": forms, "context": given.context, "key": given.key}
    with Loopback(plan, port=given.port, **settings) as server, suppress(KeyboardInterrupt):
        print(server.port, flush=True)
        threading.Event().wait()


if __name__ == "__main__":
    main()
