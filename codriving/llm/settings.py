"""The settings of a language model, checked, and its key, which is read when it is used and stored nowhere."""

import os
import re
from dataclasses import dataclass
from urllib.parse import urlsplit

from codriving.errors import ConfigError, ModelError

CACHE_MODES = ("off", "use", "replay")

_VARIABLE = re.compile(r"[A-Z][A-Z0-9_]*")
_ADDRESS = "an address such as http://127.0.0.1:8000/v1"
_RANGES = {
    "temperature": (0, 2, ""),
    "max_tokens": (1, 100_000, ""),
    "deadline": (0.1, 3600, " s"),
    "attempts": (1, 20, ""),
    "max_concurrency": (1, 1000, ""),
    "failures_in_a_row": (1, 1000, ""),
}


@dataclass(frozen=True)
class ModelSettings:
    """The settings of a model through LiteLLM."""

    model: str
    api_base: str | None  # Address of the server; None for the provider's own
    api_key_env: str | None  # Name of the environment variable that holds the key; None sends none
    temperature: float | None  # Sampling temperature; None leaves it to the server
    max_tokens: int  # Longest answer [tokens]
    deadline: float  # How long one attempt may take, from sending to the last byte [s]
    attempts: int
    max_concurrency: int
    cache: str  # ``off``, ``use`` (asks what is not there) or ``replay`` (asks nothing)
    cache_file: str
    max_cost: float | None  # What the batch may cost [USD]; None sets no limit
    max_tokens_total: int | None  # Tokens that the batch may use; None sets no limit
    input_cost_per_token: float | None  # Price of a token of the prompt [USD]; None takes LiteLLM's
    output_cost_per_token: float | None  # Price of a token of the answer [USD]; None takes LiteLLM's
    failures_in_a_row: int
    ask_plain: bool
    prompts: str | None  # Folder with templates that replace ours; None takes ours

    def __post_init__(self) -> None:
        prices = self.input_cost_per_token, self.output_cost_per_token
        _require(self.model.strip(), "model must be the name of a model, got an empty text")
        check_address("api_base", self.api_base)
        _require(
            self.api_key_env is None or _VARIABLE.fullmatch(self.api_key_env),
            "api_key_env must be the name of an environment variable, in capitals, and never the key itself; "
            "what was given is not shown",
        )
        for name, (low, high, unit) in _RANGES.items():
            value = getattr(self, name)
            _require(value is None or low <= value <= high, f"{name} must be {low:g} to {high:g}{unit}, got {value}")
        _require(self.cache in CACHE_MODES, f"cache must be one of {', '.join(CACHE_MODES)}, got {self.cache}")
        _require(self.cache_file.strip(), "cache_file must be the name of a file, got an empty text")
        for name, unit in (("max_cost", " USD"), ("max_tokens_total", "")):
            limit = getattr(self, name)
            _require(limit is None or limit > 0, f"{name} must be above 0{unit}, got {limit}")
        for name, price in zip(("input_cost_per_token", "output_cost_per_token"), prices, strict=True):
            _require(price is None or price >= 0, f"{name} must be 0 USD or more, got {price}")
        _require(
            prices.count(None) != 1,
            "input_cost_per_token must be given together with output_cost_per_token, got one of them alone",
        )


def check_address(name: str, address: str | None) -> None:
    """Check the address of a server, None being the provider's own."""
    if address is None:
        return
    parts = urlsplit(address)
    _require(
        parts.username is None and parts.password is None and not parts.query,
        f"{name} must be {_ADDRESS} with no name, password or key in it; put the key into the environment",
    )
    _require(parts.scheme in ("http", "https") and parts.hostname, f"{name} must be {_ADDRESS}, got {address}")


def read_key(variable: str | None, api_base: str | None, model: str, base_setting: str, key_setting: str) -> str | None:
    """Read the key of a server from the environment."""
    if variable is None:
        if api_base is None:
            raise ModelError(
                f"{base_setting} must be the address of your server, for instance http://127.0.0.1:8000/v1, got null; "
                f"only with {key_setting} can it be left out"
            )
        return None
    key = os.environ.get(variable, "").strip()
    if not key:
        raise ModelError(
            f"{variable} is not set; put the key of the {model} into that environment variable, or set "
            f"{key_setting} to the name of another one (null if the server wants no key)"
        )
    if not all("!" <= character <= "~" for character in key):
        raise ModelError(f"{variable} holds characters that no key has; set it to the key alone")
    return key


def _require(condition: object, message: str) -> None:
    if not condition:
        raise ConfigError(message)
