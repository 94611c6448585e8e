"""What a call failed with, told from what went over the wire, and that no key is repeated."""

from datetime import UTC, datetime, timedelta
from email.utils import format_datetime

import httpx
import pytest

from codriving.llm.faults import CallError, Kind, fault_of, redacted

REQUEST = httpx.Request("POST", "http://server/v1/chat/completions")


def from_server(status: int, text: str, headers: dict[str, str] | None = None) -> CallError:
    """As LiteLLM raises it: an exception of its own, with the one of httpx behind it."""
    response = httpx.Response(status, request=REQUEST, headers=headers)
    try:
        try:
            raise httpx.HTTPStatusError("x", request=REQUEST, response=response)
        except httpx.HTTPStatusError as inner:
            raise RuntimeError(f"litellm.BadRequestError: OpenAIException - {text}") from inner
    except RuntimeError as err:
        return fault_of(err, "canary")


def on_the_way(error: Exception) -> CallError:
    try:
        try:
            raise error
        except Exception:
            raise RuntimeError("litellm.InternalServerError: Connection error.")  # noqa: B904 - as LiteLLM does
    except RuntimeError as err:
        return fault_of(err, "canary")


@pytest.mark.parametrize(
    ("status", "text", "kind"),
    [
        (401, "Incorrect API key", Kind.KEY),
        (403, "forbidden", Kind.KEY),
        (404, "The model `x` does not exist", Kind.MODEL),
        (402, "pay", Kind.QUOTA),
        (429, "Rate limit reached", Kind.RATE),
        (429, "You exceeded your current quota, insufficient_quota", Kind.QUOTA),
        (500, "invalid_request_error", Kind.SERVER),
        (502, "<html>", Kind.SERVER),
        (529, "overloaded", Kind.SERVER),
        (408, "slow", Kind.TIMEOUT),
        (400, "This model's maximum context length is 4096 tokens", Kind.TOO_LONG),
        (400, "prompt is too long: 210000 tokens > 200000 maximum", Kind.TOO_LONG),
        (413, "Request Entity Too Large", Kind.TOO_LONG),
        (400, "Invalid parameter: 'response_format' of type 'json_schema' is not supported", Kind.FORM),
        (422, "Failed to parse grammar", Kind.FORM),
        (400, "rejected by our content policy", Kind.FILTERED),
        (400, "Invalid value for 'temperature'", Kind.REFUSED),
        (400, "max_tokens is too large: 99999", Kind.REFUSED),
        (200, "Unable to get json response", Kind.UNREADABLE),
    ],
)
def test_status_and_text_decide(status: int, text: str, kind: Kind) -> None:
    assert from_server(status, text).kind is kind


@pytest.mark.parametrize(
    ("error", "kind"),
    [
        (httpx.ConnectError("refused"), Kind.UNREACHABLE),
        (httpx.ConnectTimeout("no answer"), Kind.UNREACHABLE),
        (httpx.ReadTimeout("slow"), Kind.TIMEOUT),
        (httpx.RemoteProtocolError("disconnected"), Kind.DROPPED),
        (httpx.ReadError("reset"), Kind.DROPPED),
        (ValueError("Expecting value"), Kind.UNREADABLE),
    ],
)
def test_connection_decides(error: Exception, kind: Kind) -> None:
    assert on_the_way(error).kind is kind


def test_words_are_short_one_line_and_without_keys() -> None:
    fault = from_server(400, f"You sent canary\nand Bearer something {'x' * 1000}")
    assert fault.detail.startswith("400: You sent *** and Bearer *** x")
    assert len(fault.detail) < 320
    assert "\n" not in str(fault)


def test_wait_is_read_in_seconds_and_as_a_date() -> None:
    assert from_server(429, "x", {"Retry-After": "7"}).retry_after == 7
    assert from_server(429, "x", {"Retry-After": "-7"}).retry_after == 0
    assert from_server(429, "x", {"Retry-After": "soon"}).retry_after is None
    assert from_server(429, "x").retry_after is None
    later = format_datetime(datetime.now(UTC) + timedelta(seconds=90), usegmt=True)
    assert from_server(429, "x", {"Retry-After": later}).retry_after == pytest.approx(89, abs=2)


KEY = "canary/7f+3a"


@pytest.mark.parametrize(
    "text",
    [
        f"Incorrect API key provided: {KEY}.",
        f"You sent 'Authorization: Bearer {KEY}'",
        "GET https://host/v1?key=canary%2F7f%2B3a failed",
        f"{{'authorization': 'Basic {KEY}', 'x-api-key': '{KEY}'}}",
    ],
)
def test_key_is_taken_out(text: str) -> None:
    hidden = redacted(text, KEY)
    assert "canary" not in hidden
    assert "***" in hidden


@pytest.mark.parametrize(
    "text", ["Bearer abcdef", "x-api-key: abcdef", "api_key=abcdef", "sk-abcdef1234", "sk-ab****cdef", "Basic abcdef=="]
)
def test_what_looks_like_a_key_is_taken_out_even_if_it_is_another(text: str) -> None:
    assert "abcdef" not in redacted(text, None)
    assert "cdef" not in redacted(text, None)


def test_other_text_stays() -> None:
    text = "400: max_tokens must be at most 16384, got 99999; the key is fine"
    assert redacted(text, "") == text
