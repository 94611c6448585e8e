"""The folder of a training: its config, its checkpoint, its curve and the weights it has come to."""

import hashlib
import json
import signal
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Any

from codriving.config import show
from codriving.errors import RunFolderError
from codriving.runs import locked, write_text

_FIRST_WORLD = ("world", {"suite": "paper"})  # Configs that do not name a world yet are of this one


@dataclass(frozen=True, slots=True)
class TrainingFolder:
    """Where a training is kept."""

    path: Path
    command: str
    fingerprint: str
    best: Path

    @property
    def checkpoint(self) -> Path:
        """Folder of what the training goes on from."""
        return self.path / "checkpoint"

    def state(self, decisions: int) -> Path:
        """Return the file of the weights as they were validated after some decisions."""
        return self.path / "states" / f"{decisions:09d}.safetensors"


def fingerprint(config: Mapping[str, Any]) -> str:
    """Reduce the names and values of a training to a short text; where its classes stand does not count."""
    told = {key: value for key, value in config.items() if (key, value) != _FIRST_WORLD}
    return hashlib.sha256(json.dumps(_values(told), sort_keys=True).encode()).hexdigest()[:16]


def _values(node: Any) -> Any:  # noqa: ANN401 - any plain value
    if isinstance(node, Mapping):
        return {key: _values(value) for key, value in node.items() if key != "_target_"}
    return [_values(value) for value in node] if isinstance(node, list) else node


@contextmanager
def open_folder(path: Path, name: str, command: str, config: Mapping[str, Any]) -> Iterator[TrainingFolder]:
    """Make the folder of a training, or open it again."""
    text, file = show(config), path / "config.yaml"
    try:
        (path / "states").mkdir(parents=True, exist_ok=True)
        with locked(path):
            if not file.exists():
                write_text(file, text)
            elif file.read_text(encoding="utf-8") != text:
                raise RunFolderError(
                    f"{path} is a training with other settings; choose another run=<name>, or delete it"
                )
            yield TrainingFolder(path, command, fingerprint(config), path / f"{name}.safetensors")
    except OSError as err:
        raise RunFolderError(f"cannot write {err.filename or path}: {err.strerror or err}") from err


class Stop:
    """Whether the user wants a training to stop; the first Ctrl-C asks for it, the second one insists."""

    def __init__(self) -> None:
        self.wanted = False

    @contextmanager
    def listening(self) -> Iterator[None]:
        """Listen for Ctrl-C, SIGTERM and SIGHUP; a training stops between two episodes: its checkpoint is exact."""

        def note(signum: int, frame: FrameType | None) -> None:
            if self.wanted:
                raise KeyboardInterrupt
            self.wanted = True

        numbers = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
        # What is ignored stays so, as ``nohup`` wants it.
        before = {n: signal.signal(n, note) for n in numbers if signal.getsignal(n) is not signal.SIG_IGN}
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
