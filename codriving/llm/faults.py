"""What a call failed with, told from what went over the wire, and the one line that says what to set."""

import json
import math
import os
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from enum import Enum
from typing import Any
from urllib.parse import quote, urlsplit

import httpx

from codriving.errors import ModelError, ModelUnavailableError
from codriving.llm.parsing import one_line
from codriving.llm.settings import ModelSettings

HIDDEN = "***"

# What is left of a key after a server has masked the middle of it is hidden, too.
_BEARER = re.compile(r"(?i)\b(bearer|basic)\s+[^\s\"',;}]+")
_HEADER = re.compile(
    r"(?i)\b((?:proxy-)?authorization|x-api-key|api[-_]key)(\"?'?\s*[:=]\s*\"?'?)(?!bearer|basic)[^\s\"',;}]+"
)
_SECRET = re.compile(r"\bsk-[\w*.\-]{6,}|\bAIza[\w\-]{20,}")


def without_key(text: str, key: str | None) -> str:
    """Take one key out of a text, as it is and as it stands in an address."""
    for written in {key, quote(key, safe="")} if key else ():
        text = text.replace(written, HIDDEN)
    return text


def redacted(text: str, key: str | None) -> str:
    """Take everything out of an error text that is a key or looks like one."""
    text = _BEARER.sub(rf"\1 {HIDDEN}", without_key(text, key))
    return _SECRET.sub(HIDDEN, _HEADER.sub(rf"\1\2{HIDDEN}", text))


_UNREADABLE = re.compile(
    r"(?i)empty or invalid response|invalid response object|returned 'choices'|unable to (get|parse) json"
)
_NO_PROVIDER = re.compile(r"(?i)LLM Provider NOT provided")
_PREFIX = re.compile(r"^(?:(?:litellm\.)?\w*(?:Error|Exception|Timeout)(?: -|:)\s*)+")
_LONGEST = 300


class FaultKind(Enum):
    """Kinds of faults, each of which is met in its own way."""

    TIMEOUT = "did not answer in time"
    DROPPED = "dropped the connection"
    RATE = "takes no more requests for now"
    SERVER = "failed"
    UNREACHABLE = "cannot be reached"
    KEY = "refuses the key"
    QUOTA = "has no credit left for this key"
    MODEL = "does not know the model"
    FORM = "does not support this form of answer"
    TOO_LONG = "finds the question too long"
    FILTERED = "refuses the question"
    UNREADABLE = "sent something that is no chat completion"
    OVERSIZE = "sent more than an answer can be"
    REDIRECT = "redirects"
    REFUSED = "refuses the request"
    VARIABLE = "cannot be asked"  # For a variable of the environment, not for what a server says

    @property
    def passes(self) -> bool:
        """Whether the same request may work in a moment."""
        return self in (FaultKind.TIMEOUT, FaultKind.DROPPED, FaultKind.RATE, FaultKind.SERVER, FaultKind.UNREACHABLE)


class CallError(Exception):
    """Raised by one attempt that failed; it never leaves this room.

    Attributes:
        retry_after: How long the server asks to wait [s]; None if it doesn't say.
    """

    def __init__(self, kind: FaultKind, detail: str = "", retry_after: float | None = None) -> None:
        super().__init__(kind, detail, retry_after)
        self.kind, self.detail, self.retry_after, self.attempts = kind, detail, retry_after, 1

    def __str__(self) -> str:
        return f"{self.kind.value} ({self.detail})" if self.detail else self.kind.value


def fault_of(error: BaseException, key: str | None) -> CallError:
    """Tell what went wrong.

    LiteLLM names its exceptions after words in the body and gives status 500 to a connection that was never made, so
    the HTTP exception in the chain of causes decides where there is one.
    """
    chain = list(_chain(error))
    detail = _words(str(error), key)
    for link in chain:
        if isinstance(link, CallError):
            return CallError(link.kind, _words(link.detail, key), link.retry_after)
        if isinstance(link, httpx.HTTPStatusError):
            status, headers = link.response.status_code, link.response.headers
            return CallError(_kind(status, str(error)), f"{status}: {detail}", _wait(headers, [], str(error)))
        if isinstance(link, httpx.ConnectError | httpx.ConnectTimeout | httpx.UnsupportedProtocol | httpx.InvalidURL):
            return CallError(FaultKind.UNREACHABLE, _words(str(link), key))
        if isinstance(link, httpx.TimeoutException | TimeoutError):
            return CallError(FaultKind.TIMEOUT)
        if isinstance(link, httpx.TransportError):
            return CallError(FaultKind.DROPPED, _words(str(link), key))
    if any(isinstance(link, ValueError | RecursionError) for link in chain) or _UNREADABLE.search(str(error)):
        return CallError(FaultKind.UNREADABLE, detail)
    if _NO_PROVIDER.search(str(error)):
        return CallError(FaultKind.MODEL, "LiteLLM knows no provider of that name")
    number = getattr(error, "status_code", None)
    return CallError(_kind(number if isinstance(number, int) else 400, str(error)), detail)


def _chain(error: BaseException | None) -> Iterator[BaseException]:
    seen: set[int] = set()
    while error is not None and id(error) not in seen:
        seen.add(id(error))
        yield error
        error = error.__cause__ or error.__context__


def _words(text: str, key: str | None) -> str:
    """Shorten a text for a message; keys go first, so that none is cut in half and overlooked."""
    said = redacted(text, key).partition("Traceback (most recent call last)")[0]  # Of LiteLLM, in the text of its error
    return one_line(_PREFIX.sub("", said), _LONGEST)


_KINDS = {
    FaultKind.KEY: (401, 403),
    FaultKind.QUOTA: (402,),
    FaultKind.MODEL: (404,),
    FaultKind.TIMEOUT: (408, 504, 524),
    FaultKind.TOO_LONG: (413,),
}
_BY_STATUS = {status: kind for kind, numbers in _KINDS.items() for status in numbers}

_CODES = {
    FaultKind.QUOTA: "insufficient_quota|insufficient_(credits?|balance|funds)|billing_(hard_limit_reached|not_active)",
    FaultKind.TOO_LONG: "context_length_exceeded|string_above_max_length|exceed_context_size_error",
    FaultKind.FILTERED: "content_filter|content_policy_violation|responsible_ai_policy_violation",
    FaultKind.MODEL: "model_not_found|unknown_model|not_found_error",
}

# Looked at last, where neither status nor code nor a named wait decides.
_TOO_LONG = re.compile(
    r"(?i)context[ _-]?(length|window|size)|maximum context|too many tokens|prompt is too long|"
    r"\b(input|prompt|messages)\b.{0,40}(too long|too large|exceeds?\b.{0,40}\btokens?|longer than)"
)
_FORM = re.compile(
    r"(?i)response_?format|response_?schema|json_schema|json_object|json mode|schema|grammar|guided|structured output"
)
_FILTERED = re.compile(r"(?i)content[ _-]?(policy|filter)|safety system|content management policy")
_RESET = re.compile(r"(?i)(x-|anthropic-)?ratelimit-(.+-)?reset(-.+)?")
_NO_MONEY = re.compile(r"(?i)insufficient_quota|exceeded your current quota|billing|credit balance")


def fault_of_response(status: int, headers: Mapping[str, str], text: str) -> CallError:
    """Tell what a response of status 400 or more means."""
    told = list(_told(_json(text)))
    codes = {value for name, value in told if name in ("code", "type", "status", "reason")}
    wait = _wait(headers, told, text)
    message = next((value for name, value in told if name in ("message", "detail", "msg", "error")), "") or text
    limits = any(_RESET.fullmatch(name) for name in headers)
    # LiteLLM takes seconds over a long one.
    return CallError(_kind(status, text, codes, wait, limits), f"{status}: {message[:2000]}", wait)


def _kind(
    status: int,
    text: str,
    codes: set[str] = frozenset(),  # type: ignore[assignment]
    wait: float | None = None,
    limits: bool = False,
) -> FaultKind:
    """Tell one refusal from another.

    Args:
        limits: Whether a header says when a limit of the rate ends.
    """
    if status < 400:
        return FaultKind.UNREADABLE
    by_code = [kind for kind, names in _CODES.items() if any(re.fullmatch(names, code.lower()) for code in codes)]
    if status < 500 and by_code and not (status in (401, 413) or (status == 429 and by_code[0] is not FaultKind.QUOTA)):
        return by_code[0]
    if status in _BY_STATUS:
        return _BY_STATUS[status]
    if status == 429:
        said = wait is None and not limits and "rate_limit_exceeded" not in codes and _NO_MONEY.search(text)
        return FaultKind.QUOTA if said else FaultKind.RATE
    if status in (400, 422) and _TOO_LONG.search(text):
        return FaultKind.TOO_LONG
    if status in (400, 422, 501) and _FORM.search(text):
        return FaultKind.FORM
    if status in (409, 425) or (status >= 500 and status != 501):
        return FaultKind.SERVER
    return FaultKind.FILTERED if _FILTERED.search(text) else FaultKind.REFUSED


def refusal_within(body: bytes) -> CallError | None:
    """Tell a refusal that a gateway sends with status 200."""
    if b'"error"' not in body[:4000]:
        return None
    told = _json(body.decode("utf-8", "replace"))
    error = told.get("error") if isinstance(told, dict) else None
    if not error or "choices" in told:
        return None
    code = error.get("code") if isinstance(error, dict) else None
    with suppress(TypeError, ValueError):
        if 400 <= int(code or 0) < 600:
            return fault_of_response(int(code or 0), {}, json.dumps(told))
    return fault_of_response(400, {}, json.dumps(told))


def _json(text: str) -> Any:  # noqa: ANN401 - any JSON
    with suppress(ValueError, RecursionError):
        return json.loads(text)
    return None


def _told(node: Any, depth: int = 0) -> Iterator[tuple[str, str]]:  # noqa: ANN401 - any JSON
    """Names and values of what an error body says, the outermost first."""
    if isinstance(node, list):
        node = {str(k): item for k, item in enumerate(node[:20])}
    if not isinstance(node, Mapping) or depth > 5:
        return
    for name, value in node.items():
        if isinstance(value, str | int | float) and not isinstance(value, bool):
            yield str(name).lower(), str(value)
    for value in node.values():
        yield from _told(value, depth + 1)


_UNITS = {"ms|msecs?|milliseconds?": 0.001, "s|secs?|seconds?": 1.0, "m|mins?|minutes?": 60.0, "h|hours?": 3600.0}
_LENGTH = rf"(?i:(\d+(?:\.\d+)?)\s*({'|'.join(_UNITS)})(?![a-z]))"
_NAMED = re.compile(
    rf"(?i)\b(?:try again|retry|retrying|wait|reset|resets|available)\b[^.\d]{{0,40}}?((?:{_LENGTH}\s*)+)"
)
_FIELDS = {"retrydelay": 1.0, "retry_delay": 1.0, "retry_after": 1.0, "retry_after_seconds": 1.0, "retry-after": 1.0}
_FIELDS |= {"retryafter": 1.0, "retry_after_ms": 0.001, "retryafterms": 0.001}


def _wait(headers: Mapping[str, str], told: list[tuple[str, str]], text: str) -> float | None:
    """How long the server asks to wait [s]: in a header (RFC 9110, 10.2.3, or in milliseconds), a field or words."""
    found = _seconds(headers.get("retry-after-ms", ""), 0.001)
    found = _retry_after(headers) if found is None else found
    for name, value in told:
        if found is None and name in _FIELDS:
            found = _seconds(value, _FIELDS[name])
    if found is None and (named := _NAMED.search(text[:20_000])):
        found = _seconds(named[1], 1.0)
    return found


def _seconds(text: str, unit: float) -> float | None:
    """Read a number of a unit, or lengths with units of their own such as ``6m0s``."""
    with suppress(ValueError):
        return None if math.isnan(number := float(text)) else max(0.0, number * unit)
    lengths = re.findall(_LENGTH, text)
    sizes = [size for _, name in lengths for names, size in _UNITS.items() if re.fullmatch(names, name.lower())]
    return sum(float(number) * size for (number, _), size in zip(lengths, sizes, strict=True)) if lengths else None


def _retry_after(headers: Mapping[str, str]) -> float | None:
    """Read how long to wait, given in seconds or as a date (RFC 9110, 10.2.3)."""
    given = headers.get("retry-after", "").strip()
    if (seconds := _seconds(given, 1.0)) is not None:
        return seconds
    with suppress(ValueError, TypeError, OverflowError):
        when = parsedate_to_datetime(given)
        return max(0.0, (when.replace(tzinfo=when.tzinfo or UTC) - datetime.now(UTC)).total_seconds())
    return None


def unusable(fault: CallError, settings: ModelSettings) -> ModelError:
    """Say that a model cannot be used, and what to set."""
    where, said = settings.where, f" ({fault.detail})" if fault.detail else ""
    variable = settings.api_key_env
    key = variable or "the variable that llm.api_key_env names"
    if fault.kind is FaultKind.KEY and variable is None:
        cure = "set llm.api_key_env to the name of the variable that holds the key"
        return ModelError(f"{where} refuses requests without a key{said}; {cure}")
    which = {FaultKind.KEY: f" in {variable}", FaultKind.MODEL: f" {settings.model}"}.get(fault.kind, "")
    cure = {
        FaultKind.KEY: f"set {key} to a valid key",
        FaultKind.MODEL: "set llm.model to one that it has, or check llm.api_base",
        FaultKind.UNREACHABLE: f"start the server{_by_proxy(settings)}, or set llm.api_base to its address",
        FaultKind.VARIABLE: "mend that environment variable, or unset it",
        FaultKind.QUOTA: f"buy some, or set {key} to another key",
        FaultKind.REDIRECT: "set llm.api_base to that address if it may have the prompts and the key",
        FaultKind.OVERSIZE: "check llm.api_base and llm.max_tokens",
        FaultKind.UNREADABLE: "set llm.api_base to the address of its API, which often ends in /v1",
        FaultKind.TIMEOUT: f"{SLOW}, or check llm.api_base",
        FaultKind.RATE: "try later, or raise llm.attempts",
        FaultKind.SERVER: "try later, or check llm.model and llm.api_base",
        FaultKind.DROPPED: "try later, or check llm.api_base",
    }.get(fault.kind) or _cure(fault.detail)
    return ModelError(f"{where} {fault.kind.value}{which}{said}; {cure}")


PROXIES = ("HTTP_PROXY", "HTTPS_PROXY", "ALL_PROXY", "NO_PROXY")
LOOPBACK = ("127.0.0.1", "localhost", "[::1]")


def set_of(*names: str) -> list[str]:
    """Say which variables are set, in whatever case they are written."""
    return sorted(name for name, value in os.environ.items() if value and name.upper() in names)


def _by_proxy(settings: ModelSettings) -> str:
    """What may be to blame in the place of a server that is not on this machine."""
    names = set_of(*PROXIES[:3])
    if not names or urlsplit(settings.api_base or "").hostname in {host.strip("[]") for host in LOOPBACK}:
        return ""
    return f" or the proxy of {' and '.join(names)} (unset to ask directly)"


SLOW = "raise llm.deadline or lower llm.max_concurrency"

# What a refusal may be about, and the setting of ours for it; the first that it names counts.
_SETTINGS = {
    "max_tokens|max_completion_tokens|max_output_tokens|num_predict": "llm.max_tokens_field, or lower llm.max_tokens",
    "temperature|top_p|top_k": "llm.temperature=null",
    "reasoning|effort|thinking|think\\b": "llm.extra, for instance llm.extra={reasoning_effort: low}",
    "stream": "llm.stream=true",
    "role|system|developer": "llm.system_role=user",
    "api.?version|header": "llm.headers",
}


def _cure(detail: str) -> str:
    for words, setting in _SETTINGS.items():
        if re.search(f"(?i){words}", detail):
            return f"set {setting}"
    return "change the setting of llm that it complains about, or give the field that it wants in llm.extra"


def unavailable(fault: CallError, settings: ModelSettings) -> ModelUnavailableError:
    """Say that a model did not answer this time."""
    times = "once" if fault.attempts == 1 else f"{fault.attempts} times"
    cures = {FaultKind.TIMEOUT: f"; {SLOW}", FaultKind.REFUSED: f"; {_cure(fault.detail)}"}
    cure = cures.get(fault.kind, "")
    return ModelUnavailableError(f"{settings.model}: {settings.where} {fault}, asked {times}{cure}")
