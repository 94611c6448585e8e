"""The settings of a language model, checked; what ``conf/llm/*.yaml`` builds."""

import os
import re
import threading
from dataclasses import dataclass, fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar
from urllib.parse import urlsplit

from codriving.errors import ConfigError

if TYPE_CHECKING:
    from codriving.llm.client import ModelChat

CACHE_MODES = ("off", "use", "replay")

_VARIABLE = re.compile(r"[A-Z][A-Z0-9_]*")
_NOT_THE_CLIENTS = ("failures_in_a_row", "ask_plain", "prompts")


@dataclass(frozen=True)
class LanguageModel:
    """A model through LiteLLM.

    Attributes:
        api_base: Address of the server; None for the provider's own.
        api_key_env: Name of the environment variable that holds the key; None sends none.
        temperature: Sampling temperature; None leaves it to the server.
        max_tokens: Longest answer [tokens].
        deadline: How long one attempt may take, from sending to the last byte [s].
        cache: ``off``, ``use`` (asks what is not there) or ``replay`` (asks nothing).
        max_cost: What the batch may cost [USD]; None sets no limit.
        max_tokens_total: Tokens that the batch may use; None sets no limit.
        input_cost_per_token: Price of a token of the prompt [USD]; None takes LiteLLM's.
        output_cost_per_token: Price of a token of the answer [USD]; None takes LiteLLM's.
        prompts: Folder with templates that replace ours; None takes ours.

    Raises:
        ConfigError: If a setting breaks its rule.
    """

    model: str
    api_base: str | None
    api_key_env: str | None
    temperature: float | None
    max_tokens: int
    deadline: float
    attempts: int
    max_concurrency: int
    cache: str
    cache_file: str
    max_cost: float | None
    max_tokens_total: int | None
    input_cost_per_token: float | None
    output_cost_per_token: float | None
    failures_in_a_row: int
    ask_plain: bool
    prompts: str | None

    _shared: ClassVar["dict[tuple[object, ...], ModelChat]"] = {}
    _lock: ClassVar[threading.Lock] = threading.Lock()

    def __post_init__(self) -> None:
        _require(bool(self.model.strip()), "model must be the name of a model, got an empty text")
        _check_address(self.api_base)
        _require(
            self.api_key_env is None or bool(_VARIABLE.fullmatch(self.api_key_env)),
            "api_key_env must be the name of an environment variable, in capitals, and never the key itself; "
            "what was given is not shown",
        )
        if self.temperature is not None:
            _require_range("temperature", self.temperature, 0, 2)
        _require_range("max_tokens", self.max_tokens, 1, 100_000)
        _require_range("deadline", self.deadline, 0.1, 3600, " s")
        _require_range("attempts", self.attempts, 1, 20)
        _require_range("max_concurrency", self.max_concurrency, 1, 1000)
        _require_range("failures_in_a_row", self.failures_in_a_row, 1, 1000)
        _require(self.cache in CACHE_MODES, f"cache must be one of {', '.join(CACHE_MODES)}, got {self.cache}")
        _require(bool(self.cache_file.strip()), "cache_file must be the name of a file, got an empty text")
        _require(self.max_cost is None or self.max_cost > 0, f"max_cost must be above 0 USD, got {self.max_cost}")
        _require(
            self.max_tokens_total is None or self.max_tokens_total > 0,
            f"max_tokens_total must be above 0, got {self.max_tokens_total}",
        )
        for name in ("input_cost_per_token", "output_cost_per_token"):
            price = getattr(self, name)
            _require(price is None or price >= 0, f"{name} must be 0 USD or more, got {price}")
        _require(
            (self.input_cost_per_token is None) == (self.output_cost_per_token is None),
            "input_cost_per_token must be given together with output_cost_per_token, got one of them alone",
        )

    @property
    def name(self) -> str:
        """Name for tables."""
        return self.model

    def chat(self) -> "ModelChat":
        """Return the client for these settings; the whole process shares one."""
        own = (getattr(self, field.name) for field in fields(self) if field.name not in _NOT_THE_CLIENTS)
        key = (os.getpid(), *own)
        with self._lock:
            if key not in self._shared:
                self._shared[key] = self._connect()
            return self._shared[key]

    def _connect(self) -> "ModelChat":
        from codriving.llm.cache import AnswerCache
        from codriving.llm.client import ModelChat
        from codriving.llm.prices import cost_of
        from codriving.llm.settings import Settings
        from codriving.llm.spending import Spending

        settings = Settings(
            model=self.model,
            api_base=self.api_base,
            api_key_env=self.api_key_env,
            temperature=self.temperature,
            max_tokens=self.max_tokens,
            deadline=self.deadline,
            attempts=self.attempts,
            max_concurrency=self.max_concurrency,
            replay=self.cache == "replay",
        )
        return ModelChat(
            settings,
            price=partial(
                cost_of,
                self.model,
                input_price=self.input_cost_per_token,
                output_price=self.output_cost_per_token,
            ),
            spending=Spending(self.max_cost, self.max_tokens_total),
            cache=None if self.cache == "off" else AnswerCache(Path(self.cache_file), self.cache),
        )


def _require(condition: bool, message: str) -> None:
    if not condition:
        raise ConfigError(message)


def _require_range(name: str, value: float, low: float, high: float, unit: str = "") -> None:
    _require(low <= value <= high, f"{name} must be {low:g} to {high:g}{unit}, got {value:g}")


def _check_address(address: str | None) -> None:
    if address is None:
        return
    example = "an address such as http://127.0.0.1:8000/v1"
    parts = urlsplit(address)
    _require(
        parts.username is None and parts.password is None and not parts.query,
        f"api_base must be {example} with no name, password or key in it; put the key into the environment",
    )
    _require(parts.scheme in ("http", "https") and bool(parts.hostname), f"api_base must be {example}, got {address}")
