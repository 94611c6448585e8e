"""The only place that knows llama.cpp: it runs in this process, and one request at a time."""

import asyncio
import ctypes
import json
import os
import secrets
import signal
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from codriving.errors import ModelError
from codriving.llm.connections import merge
from codriving.llm.events import joined
from codriving.llm.faults import fault_of_response, refusal_within
from codriving.llm.loop import loop
from codriving.llm.request import ChatRequest, Reply, response_format, spoken, worded
from codriving.llm.send import Sender, reply_of

_PATIENCE = 4.0  # How long the end of the program waits for an answer to be given up [s]

_BATCH = 256  # Tokens of a prompt worked off at once; after each the model looks whether its answer is still wanted

# A prompt is worked off as a whole, not from where it differs from the last one: in pieces of other lengths the last
# digits differ, and an answer would depend on what was asked before.
_ALIKE = {"cache_prompt": False}


class LocalSender(Sender):
    """Has a file answer that the whole process loads once."""

    def __init__(self, find: Callable[[], Path], threads: int, context: int) -> None:
        self._find, self._settings = find, (threads, context)

    async def load(self) -> None:
        """Load the model, which may take long the first time, so that no deadline runs meanwhile."""
        self._llama()

    def _llama(self) -> "Llama":
        # No await in here: two questions never load it twice.
        path = self._find()
        wanted = os.getpid(), path, *self._settings
        if wanted not in _loaded:
            _loaded[wanted] = Llama(path, *self._settings)
            loop().at_close(_loaded[wanted].close)
        return _loaded[wanted]

    async def send(
        self, request: ChatRequest, form: str, key: str | None, deadline: float, key_header: str | None = None
    ) -> Reply:
        """Have a request answered once."""
        messages = spoken(worded(request.messages, form, request.schema), request.system_role)
        body: dict[str, Any] = {"messages": [asdict(message) for message in messages], **_ALIKE}
        limit = request.max_tokens if request.max_tokens_field else None
        wish = response_format(form, request.schema)
        optional = {"max_tokens": limit, "temperature": request.temperature, "response_format": wish}
        body |= {name: value for name, value in optional.items() if value is not None}
        merge(body, request.extra)
        answer = joined(await self._llama().answer(body))
        if refused := refusal_within(json.dumps(answer).encode()):
            raise refused
        answer.pop("model", None)  # It is the name of the file
        return reply_of(answer, answer, form)


_loaded: "dict[tuple[int, Path, int, int], Llama]" = {}


class Llama:
    """A loaded model."""

    def __init__(self, path: Path, threads: int, context: int) -> None:
        try:
            import xllamacpp
        except ImportError as error:
            raise ModelError(
                f"llm=local runs llama.cpp in this process, for which xllamacpp is missing ({error!s:.100}); run make "
                "local in a clone of the repository, or pip install -e '.[local]' there"
            ) from error
        params = xllamacpp.CommonParams()
        params.model.path = str(path)
        params.n_ctx, params.n_batch, params.n_ubatch, params.n_parallel = context, _BATCH, _BATCH, 1
        params.cpuparams.n_threads = params.cpuparams_batch.n_threads = threads
        params.n_gpu_layers, params.fit_params, params.cache_ram_mib = 0, False, 0
        params.verbosity, params.warmup = -1, False
        # It opens a port in any case: for this machine alone, and with a key that is told to no one.
        params.hostnames, params.port, params.api_keys = ["127.0.0.1"], 0, [secrets.token_hex(32)]
        params.n_threads_http, params.ui, params.endpoint_slots = 1, False, False
        try:
            with own_signals():
                self._server: Any = xllamacpp.Server(params)
        except RuntimeError as error:
            raise ModelError(
                f"llama.cpp cannot load {path}: it is cut off, too large for this machine, or no model that answers; "
                "fetch it again, or set llm.model_file to another file"
            ) from error
        # One that is closed before its loop has begun never ends.
        self._server.handle_completions({"prompt": ".", "max_tokens": 1})
        self._calls: list[threading.Thread] = []

    async def answer(self, body: Mapping[str, Any]) -> list[Mapping[str, Any]]:
        """Return the events of an answer; a caller that stops waiting ends it."""
        text = json.dumps({**body, "stream": True, "stream_options": {"include_usage": True}})
        running, given_up = asyncio.get_running_loop(), threading.Event()
        answered: asyncio.Future[list[str] | Exception] = running.create_future()
        chunks: list[str] = []

        def take(chunk: str) -> bool:
            chunks.append(chunk)
            return given_up.is_set()

        def hand_over(said: list[str] | Exception) -> None:
            if not answered.done():
                answered.set_result(said)

        def ask() -> None:
            said: list[str] | Exception = chunks
            try:
                self._server.handle_chat_completions(text, take)
            except Exception as error:
                said = error
            with suppress(RuntimeError):  # The loop has ended meanwhile
                running.call_soon_threadsafe(hand_over, said)

        self._calls = [call for call in self._calls if call.is_alive()]
        self._calls.append(threading.Thread(target=ask, daemon=True, name="llama.cpp"))
        self._calls[-1].start()
        try:
            said = await answered
        finally:
            given_up.set()
        if isinstance(said, Exception):
            raise fault_of_response(400 if isinstance(said, ValueError) else 500, {}, str(said))
        return _events(said)

    async def close(self) -> None:
        """Give the memory back, unless an answer does not end: then the end of the process does."""
        for call in self._calls:
            call.join(_PATIENCE / len(self._calls))
        if any(call.is_alive() for call in self._calls):
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(self._server))
        self._server = None


def _events(chunks: Sequence[str]) -> list[Mapping[str, Any]]:
    events = [json.loads(chunk) for chunk in chunks]
    return [event for event in events if isinstance(event, dict)]


@contextmanager
def own_signals() -> Iterator[None]:
    """Keep what Ctrl-C does: llama.cpp takes the signals for itself, and would stop the model instead of the program.

    ``signal`` would do it in the main thread alone.
    """
    if os.name != "posix":
        yield
        return
    libc = ctypes.CDLL(None)
    kept = {number: ctypes.create_string_buffer(1024) for number in (signal.SIGINT, signal.SIGTERM)}
    for number, action in kept.items():
        libc.sigaction(int(number), None, action)
    try:
        yield
    finally:
        for number, action in kept.items():
            libc.sigaction(int(number), action, None)
