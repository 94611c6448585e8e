"""A stand-in for a language model with a fixed latency, in a process of its own, and the settings that ask it."""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

SERVER = Path(__file__).resolve().parents[1] / "tests" / "llm" / "loopback.py"


@contextmanager
def served(latency: float) -> Iterator[list[str]]:
    """Serve while the ``with`` block lasts; it shares no interpreter with the process that is measured.

    Args:
        latency: How long every answer takes [s].

    Yields:
        ``key=value`` tokens that ask it, without a limit on how many requests may be under way.
    """
    command = [sys.executable, str(SERVER), "--port", "0", "--latency", str(latency)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            assert server.stdout is not None
            port = int(server.stdout.readline())
            address = f"llm.api_base=http://127.0.0.1:{port}/v1"
            yield ["llm=custom", "llm.model=openai/toy", address, "llm.attempts=1", "llm.max_concurrency=1000"]
        finally:
            server.terminate()
