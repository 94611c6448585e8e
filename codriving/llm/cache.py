"""Answers of a language model in one file: none is paid for twice, and a run can be repeated without the model."""

import hashlib
import json
import os
import sqlite3
import threading
import weakref
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from codriving.errors import ConfigError, ModelError
from codriving.llm.cache_file import open_to_read, open_to_write

OFF, USE, REPLAY = "off", "use", "replay"
"""No cache; answers from it where it has one, and into it where not; from it alone."""

MODES = (OFF, USE, REPLAY)


class AnswerCache:
    """Replies by what was asked; any number of threads and processes may share the file, and may be killed at any time.

    Args:
        mode: ``off``, ``use`` or ``replay``.

    Raises:
        ConfigError: If there is no such mode.
    """

    def __init__(self, path: Path | str, mode: str) -> None:
        if mode not in MODES:
            raise ConfigError(f"llm.cache must be {', '.join(MODES[:-1])} or {MODES[-1]}, got {mode!r}")
        # A connection must not cross a fork, and must not even be closed there; hence it is kept by process.
        self._connections: dict[int, sqlite3.Connection] = {}
        self._lock = threading.Lock()
        self.path, self.mode = Path(path), mode
        # At the end of the program at the latest, so that the file is complete by itself.
        weakref.finalize(self, _close, self._connections)

    def find(self, request: Mapping[str, Any]) -> dict[str, Any] | None:
        """Look a reply up.

        Returns:
            The reply; None if there is none and the model may be asked.

        Raises:
            ModelError: If there is none in replay, or the file cannot be used.
        """
        if self.mode == OFF:
            return None
        if not self.path.exists():
            self._absent(request, f"there is no answer cache {self.path}")
            return None
        key = key_of(request)
        text = self._do(lambda connection: _text_of(connection, key))
        if text is None:
            self._absent(request, f"the answer cache {self.path} does not hold what is asked now")
            return None
        try:
            reply = json.loads(text)
        except ValueError as error:
            raise self._unusable(str(error)) from error
        if not isinstance(reply, dict):
            raise self._unusable("a reply is no object")
        return reply

    def keep(self, request: Mapping[str, Any], reply: Mapping[str, Any]) -> dict[str, Any]:
        """Keep a reply, unless somebody else has kept one to the same request meanwhile.

        Args:
            request: What was asked, as for ``find``.

        Raises:
            ModelError: If the file cannot be used.
        """
        if self.mode != USE:
            return dict(reply)
        key, text = key_of(request), json.dumps(reply, allow_nan=False)

        def write(connection: sqlite3.Connection) -> str | None:
            connection.execute("INSERT OR IGNORE INTO answers (key, reply) VALUES (?, ?)", (key, text))
            return _text_of(connection, key)

        return dict(json.loads(self._do(write) or text))

    def close(self) -> None:
        """Close the file; if no other process has it open, it is complete by itself then. It may be used again."""
        with self._lock:
            _close(self._connections)

    def _absent(self, request: Mapping[str, Any], fact: str) -> None:
        """Nothing is found: no matter, unless there is nobody else to ask."""
        if self.mode == REPLAY:
            raise ModelError(
                f"llm.cache=replay: {fact} (model {request.get('model', 'unknown')}); set llm.cache=use to ask the "
                "model and fill it, or llm.cache_file to the file of the run that is to be repeated"
            )

    def _do(self, action: Any) -> Any:  # noqa: ANN401 - whatever the action gives
        """Do something with the file, one thread at a time."""
        try:
            with self._lock:
                return action(self._connection())
        except (sqlite3.Error, OSError, ValueError) as error:
            raise self._unusable(str(error)) from error

    def _connection(self) -> sqlite3.Connection:
        connection = self._connections.get(os.getpid())
        if connection is None:
            connection = open_to_read(self.path) if self.mode == REPLAY else open_to_write(self.path)
            self._connections[os.getpid()] = connection
        return connection

    def _unusable(self, reason: str) -> ModelError:
        return ModelError(
            f"the answer cache {self.path} cannot be used ({reason}); move it away, set llm.cache_file to another "
            "file, or set llm.cache=off"
        )


def key_of(request: Mapping[str, Any]) -> str:
    """Give what a request is found by: the SHA-256 of its canonical JSON.

    Returns:
        64 hexadecimal digits; the same whatever the order of the keys.
    """
    text = json.dumps(request, sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def _close(connections: dict[int, sqlite3.Connection]) -> None:
    """Close the connection of this process."""
    connection = connections.pop(os.getpid(), None)
    if connection is not None:
        connection.close()


def _text_of(connection: sqlite3.Connection, key: str) -> str | None:
    row = connection.execute("SELECT reply FROM answers WHERE key = ?", (key,)).fetchone()
    return None if row is None else str(row[0])
