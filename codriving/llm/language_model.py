"""The models that ``conf/llm/*.yaml`` build: none at all, or one through LiteLLM."""

import json
import os
import threading
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from codriving.datatypes import Model, RuleModel
from codriving.llm.settings import ModelSettings

if TYPE_CHECKING:
    from codriving.llm.cache import AnswerCache
    from codriving.llm.client import ModelChat

_NOT_THE_CLIENTS = ("failures_in_a_row", "ask_plain", "thoughts", "prompts", "latency")


class Offline(RuleModel):
    """``llm=offline``: the built-in rules reason; no network, no key, deterministic, and every table says so."""


class LanguageModel(ModelSettings, Model):
    """A model through LiteLLM."""

    _shared: ClassVar["dict[str, ModelChat]"] = {}
    _lock: ClassVar[threading.Lock] = threading.Lock()

    @property
    def name(self) -> str:  # type: ignore[override]
        """Name for tables."""
        return self.label or self.model

    def chat(self) -> "ModelChat":
        """Return the client for these settings; the whole process shares one."""
        from codriving.llm.cache import AnswerCache

        own = [getattr(self, field.name) for field in fields(self) if field.name not in _NOT_THE_CLIENTS]
        key = f"{os.getpid()} {type(self).__name__} {json.dumps(own, sort_keys=True)}"
        with self._lock:
            if key not in self._shared:
                cache = None if self.cache == "off" else AnswerCache(Path(self.cache_file), self.cache)
                self._shared[key] = self.client(cache)
            return self._shared[key]

    def client(self, cache: "AnswerCache | None") -> "ModelChat":
        """Make a client for these settings."""
        from codriving.llm.client import ModelChat

        return ModelChat(self, cache=cache)
