"""The one event loop of this process, in a thread of its own; started when a model is first asked."""

import asyncio
import atexit
import os
import threading
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any, TypeVar

Result = TypeVar("Result")

_PATIENCE = 5.0  # How long the end of the program waits for connections to close [s]


class Loop:
    """An event loop that any thread can give work to; it outlives every caller, and so do its connections."""

    def __init__(self) -> None:
        self._loop = asyncio.new_event_loop()
        self._closing: list[Callable[[], Awaitable[None]]] = []
        self._thread = threading.Thread(target=self._loop.run_forever, name="language-model", daemon=True)
        self._thread.start()

    def run(self, work: Coroutine[Any, Any, Result]) -> Result:
        """Do something on the loop and wait for it, from any other thread."""
        future = asyncio.run_coroutine_threadsafe(work, self._loop)
        try:
            return future.result()
        except BaseException:
            future.cancel()
            raise

    def at_close(self, closing: Callable[[], Awaitable[None]]) -> None:
        """Note what is to be closed with the loop."""
        self._closing.append(closing)

    def close(self) -> None:
        """Close what was noted, then the loop; nothing can be asked afterwards."""
        if self._loop.is_closed() or not self._thread.is_alive():
            return
        try:
            asyncio.run_coroutine_threadsafe(self._close_all(), self._loop).result(_PATIENCE)
        finally:
            self._loop.call_soon_threadsafe(self._loop.stop)
            self._thread.join(_PATIENCE)
            if not self._thread.is_alive():
                self._loop.close()

    async def _close_all(self) -> None:
        others = asyncio.all_tasks() - {asyncio.current_task()}
        for task in others:
            task.cancel()
        await asyncio.gather(*others, return_exceptions=True)
        for closing in self._closing:
            await closing()


_lock = threading.Lock()
_running: dict[int, Loop] = {}


def loop() -> Loop:
    """Return the loop of this process; one that a fork left without its thread is not used."""
    with _lock:
        if os.getpid() not in _running:
            _running.clear()
            _running[os.getpid()] = Loop()
            atexit.register(_running[os.getpid()].close)
        return _running[os.getpid()]
