"""The settings of a language model, checked, and its key, which is read when it is used and stored nowhere."""

import json
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

from codriving.errors import ConfigError, ModelError

CACHE_MODES = ("off", "use", "replay")

LONGEST = 60.0  # Beyond this an episode is over before a question is answered [s]

_VARIABLE = re.compile(r"[A-Z][A-Z0-9_]*")
_ADDRESS = "an address such as http://127.0.0.1:8000/v1"
_RANGES = {
    "temperature": (0, 2, ""),
    "max_tokens": (1, 100_000, ""),
    "deadline": (0.1, 3600, " s"),
    "attempts": (1, 20, ""),
    "max_concurrency": (1, 1000, ""),
    "failures_in_a_row": (1, 1000, ""),
    "fallbacks_at_first": (1, 100_000, ""),
    "epoch": (1, 100, ""),
}
_HEADER = re.compile(r"[!#$%&'*+.^_`|~0-9A-Za-z-]+")
_OURS = {"model": "llm.model", "messages": "prompts", "stream": "llm.stream"}  # Set elsewhere, not by ``extra``
# Texts under such names, or of such a look, may be keys; numbers and switches are not.
_KEY_NAME = re.compile(r"(?i)(.*[^a-z])?(api|access|auth|private)?[-_]?(key|token|secret|password|credential)s?")
_KEY_HEADER = re.compile(r"(?i)(proxy-)?authorization|(set-)?cookie2?|(x-)?(goog-)?api-key|x-auth-token")
_KEY_LOOK = re.compile(
    r"(?i)\b(sk|pk|rk|gsk|hf|xai|ghp|glpat|nvapi|tgp|r8|pplx)[-_][\w*.-]{6,}|\bAIza[\w-]{20,}|"
    r"\b(bearer|basic)\s+\S{6,}|\beyJ[\w-]{10,}\.[\w-]{10,}"
)
_LONG_LOOK = re.compile(
    r"(?=\S*\d)(?=\S*[A-Za-z])[A-Za-z0-9+/=]{32,}|(?=\S*\d)(?=\S*[a-z])(?=\S*[A-Z])[\w+/=-]{32,}|"
    r"[0-9a-fA-F]{8}(-[0-9a-fA-F]{4}){3}-[0-9a-fA-F]{12}"
)


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
    thoughts: bool  # Whether a model writes its thoughts down before it answers
    prompts: str | None  # Set of prompts, or folder with templates that replace them; None takes the first set
    label: str | None  # Name in tables; None takes the model's
    model_prefix: str | None  # What the model's name has to begin with; None leaves it free
    max_tokens_field: str | None  # What the server calls its limit of an answer; None sends none
    system_role: str  # Role of the instructions: ``system``, ``developer``, or ``user``
    stream: bool  # Whether the answer is asked for bit by bit, for servers that know nothing else
    extra: Mapping[str, Any]  # Further fields of the request; null takes one out
    headers: Mapping[str, str]  # Further headers of the request, none of them a key
    api_key_header: str | None  # Header that carries the key, as it is; None takes the provider's own
    fallbacks_at_first: int  # The batch stops if the first so many questions had no usable answer
    latency: str | float  # How long a question takes in the world: ``none``, ``measured`` or a time [s]
    epoch: int  # Which time the same seeds are driven; each asks anew

    def __post_init__(self) -> None:
        prices = self.input_cost_per_token, self.output_cost_per_token
        require(self.model.strip(), "model must be the name of a model, got an empty text")
        self._check_request()
        check_address("api_base", self.api_base)
        require(
            self.api_key_env is None or _VARIABLE.fullmatch(self.api_key_env),
            "api_key_env must be the name of an environment variable, in capitals, and never the key itself; "
            "what was given is not shown",
        )
        for name, (low, high, unit) in _RANGES.items():
            value = getattr(self, name)
            require(value is None or low <= value <= high, f"{name} must be {low:g} to {high:g}{unit}, got {value}")
        require(self.cache in CACHE_MODES, f"cache must be one of {', '.join(CACHE_MODES)}, got {self.cache}")
        stated = not isinstance(self.latency, str) and 0 <= self.latency <= LONGEST
        require(
            stated or self.latency in ("none", "measured"),
            f"latency must be none, measured or a time of 0 to {LONGEST:g} s, got {self.latency}",
        )
        require(self.cache_file.strip(), "cache_file must be the name of a file, got an empty text")
        for name, unit in (("max_cost", " USD"), ("max_tokens_total", "")):
            limit = getattr(self, name)
            require(limit is None or limit > 0, f"{name} must be above 0{unit}, got {limit}")
        for name, price in zip(("input_cost_per_token", "output_cost_per_token"), prices, strict=True):
            require(price is None or price >= 0, f"{name} must be 0 USD or more, got {price}")
        require(
            prices.count(None) != 1,
            "input_cost_per_token must be given together with output_cost_per_token, got one of them alone",
        )

    @property
    def where(self) -> str:
        """Who answers, in messages."""
        return self.api_base or f"the provider of {self.model}"

    @property
    def address(self) -> str | None:
        """What an answer is kept by, beside the model's name."""
        return self.api_base

    def key(self) -> str | None:
        """Read the key from the environment."""
        return read_key(self.api_key_env, self.api_base, "model", "llm.api_base", "llm.api_key_env")

    def _check_request(self) -> None:
        prefix = self.model_prefix or ""
        require(
            self.model.startswith(prefix),
            f"model must begin with {prefix} here, or another protocol would be spoken, got {self.model}; set "
            f"llm.model={prefix}{self.model.removeprefix(prefix.split('_')[0].rstrip('/') + '/')}, or llm=custom for a "
            "server that speaks OpenAI's protocol",
        )
        require(self.label is None or self.label.strip(), "label must be a name or null, got an empty text")
        require(
            self.max_tokens_field is None or self.max_tokens_field.strip(),
            "max_tokens_field must be the name of a field (max_completion_tokens) or null, got an empty text",
        )
        require(
            self.system_role in ("system", "developer", "user"),
            f"system_role must be system, developer or user, got {self.system_role}",
        )
        for field in self.extra:
            require(field not in _OURS, f"extra must not hold {field}; it is set by {_OURS.get(field)}")
        try:
            json.dumps(self.extra, allow_nan=False)
        except ValueError:
            raise ConfigError("extra must hold what JSON can hold, got a number that is none") from None
        named_by = {"api_key_header": self.api_key_header or "", "max_tokens_field": self.max_tokens_field or ""}
        for name, value in [*texts_of(self.extra, "extra"), *texts_of(self.headers, "headers"), *named_by.items()]:
            last = name.rpartition(".")[2]
            named = _KEY_HEADER.fullmatch(last) or (_KEY_NAME.fullmatch(last) and len(value) >= 8)
            require(
                not named and not _KEY_LOOK.search(value) and not _LONG_LOOK.fullmatch(value),
                f"{_shown(name)} must hold no key, which would be in the run folder; the value is not "
                "shown: name its variable in llm.api_key_env, and a header of its own in llm.api_key_header",
            )
        for name, value in [*self.headers.items(), *([(self.api_key_header, "x")] if self.api_key_header else [])]:
            where = "headers" if name in self.headers else "api_key_header"
            require(_HEADER.fullmatch(name), f"{where} must be names of headers, got {name!r}")
            require(value.isascii() and value.isprintable(), f"{where} must hold plain texts, got others under {name}")


def _shown(name: str) -> str:
    first, _, rest = name.partition(".")
    return f"{first}[{rest}]" if rest else first


def texts_of(node: object, name: str) -> Iterator[tuple[str, str]]:
    """List the texts of nested values, each by its dotted name."""
    if isinstance(node, str):
        yield name, node
    for key, value in node.items() if isinstance(node, Mapping) else enumerate(node) if isinstance(node, list) else ():
        yield from texts_of(value, f"{name}.{key}")


def check_address(name: str, address: str | None) -> None:
    """Check the address of a server, None being the provider's own."""
    if address is None:
        return
    try:
        parts = urlsplit(address)
        require(parts.port != 0, f"{name} must be {_ADDRESS}, got {address}")
    except ValueError as error:
        raise ConfigError(f"{name} must be {_ADDRESS}, got what is no address ({error})") from error
    require(
        parts.username is None and parts.password is None and not parts.query,
        f"{name} must be {_ADDRESS} with no name, password or key in it; put the key into the environment",
    )
    require(parts.scheme in ("http", "https") and parts.hostname, f"{name} must be {_ADDRESS}, got {address}")


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


def require(condition: object, message: str) -> None:
    """Refuse a setting unless a condition holds."""
    if not condition:
        raise ConfigError(message)
