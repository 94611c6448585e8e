"""A server on loopback in the place of a language model: its answers follow from the prompts, to the letter.

What it answers is drawn from the prompt, so that a prompt that differs in one letter soon leads to another drive; one
answer in twelve cannot be used.
"""

import json
import re
import zlib
from collections.abc import Sequence
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread
from typing import Any, Self

_ALLOWED = re.compile(r"^Allowed actions: (.+)$", re.MULTILINE)
_PAIR = re.compile(r"^- (\S+): (\S+) and (\S+) \(", re.MULTILINE)


def answer(messages: Sequence[dict[str, str]]) -> str:
    """Answer a conversation.

    Args:
        messages: The conversation, each with ``role`` and ``content``.
    """
    asked = "\n".join(message["content"] for message in messages)
    draw = zlib.crc32(asked.encode())
    if draw % 12 == 0:
        return "I would rather not say."
    if allowed := _ALLOWED.findall(asked):
        actions = allowed[0].split(", ")
        return json.dumps({"reason": f"Reason {draw % 97}.", "action": actions[draw // 12 % len(actions)]})
    if pairs := _PAIR.findall(asked):
        orders = [
            {"pair": name, "first": (one, other)[draw >> k & 1], "reason": f"Reason {k}."}
            for k, (name, one, other) in enumerate(pairs)
        ]
        return json.dumps({"orders": orders})
    if '"mistake"' in asked:
        return json.dumps({"mistake": f"Mistake {draw % 97}.", "lesson": f"Lesson {draw % 89}.", "action": "SLOWER"})
    return json.dumps({"lesson": f"Lesson {draw % 89}."})


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server: "_Server"

    def do_POST(self) -> None:
        body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        messages = body["messages"]
        self.server.asked.append({"messages": messages, "response_format": body.get("response_format")})
        said = answer(messages)
        size = sum(len(message["content"]) for message in messages)
        usage = {"prompt_tokens": size // 4, "completion_tokens": len(said) // 4}
        choice = {"index": 0, "finish_reason": "stop", "message": {"role": "assistant", "content": said}}
        reply = {
            "id": "chatcmpl-0",
            "object": "chat.completion",
            "created": 0,
            "model": body["model"],
            "choices": [choice],
            "usage": {**usage, "total_tokens": sum(usage.values())},
        }
        payload = json.dumps(reply).encode()
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(payload)))
        self.end_headers()
        self.wfile.write(payload)

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing."""


class _Server(ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.asked: list[dict[str, Any]] = []


class Model:
    """Answers while the ``with`` block lasts."""

    def __enter__(self) -> Self:
        self._server = _Server()
        self._thread = Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._thread.join()
        self._server.server_close()

    @property
    def overrides(self) -> tuple[str, ...]:
        """What a user types to be answered by it, one question at a time."""
        base = f"llm.api_base=http://127.0.0.1:{self._server.server_port}/v1"
        return ("llm=custom", "llm.model=openai/drawn", base, "llm.attempts=1", "llm.max_concurrency=1")

    @property
    def asked(self) -> str:
        """All that it was asked, one JSON object a line, in the order of the questions."""
        return "".join(json.dumps(question, sort_keys=True) + "\n" for question in self._server.asked)
