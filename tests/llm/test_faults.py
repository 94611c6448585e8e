"""What a call failed with, told from what went over the wire, and that no key is repeated."""

from datetime import UTC, datetime, timedelta
from email.utils import format_datetime

import httpx
import pytest

from codriving.llm.faults import CallError, FaultKind, fault_of, fault_of_response, redacted

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
        (401, "Incorrect API key", FaultKind.KEY),
        (403, "forbidden", FaultKind.KEY),
        (404, "The model `x` does not exist", FaultKind.MODEL),
        (402, "pay", FaultKind.QUOTA),
        (429, "Rate limit reached", FaultKind.RATE),
        (429, "You exceeded your current quota, insufficient_quota", FaultKind.QUOTA),
        (500, "invalid_request_error", FaultKind.SERVER),
        (502, "<html>", FaultKind.SERVER),
        (529, "overloaded", FaultKind.SERVER),
        (408, "slow", FaultKind.TIMEOUT),
        (400, "This model's maximum context length is 4096 tokens", FaultKind.TOO_LONG),
        (400, "prompt is too long: 210000 tokens > 200000 maximum", FaultKind.TOO_LONG),
        (413, "Request Entity Too Large", FaultKind.TOO_LONG),
        (400, "Invalid parameter: 'response_format' of type 'json_schema' is not supported", FaultKind.FORM),
        (422, "Failed to parse grammar", FaultKind.FORM),
        (400, "rejected by our content policy", FaultKind.FILTERED),
        (400, "Invalid value for 'temperature'", FaultKind.REFUSED),
        (400, "max_tokens is too large: 99999", FaultKind.REFUSED),
        (200, "Unable to get json response", FaultKind.UNREADABLE),
    ],
)
def test_status_and_text_decide(status: int, text: str, kind: FaultKind) -> None:
    assert from_server(status, text).kind is kind


@pytest.mark.parametrize(
    ("error", "kind"),
    [
        (httpx.ConnectError("refused"), FaultKind.UNREACHABLE),
        (httpx.ConnectTimeout("no answer"), FaultKind.UNREACHABLE),
        (httpx.ReadTimeout("slow"), FaultKind.TIMEOUT),
        (httpx.RemoteProtocolError("disconnected"), FaultKind.DROPPED),
        (httpx.ReadError("reset"), FaultKind.DROPPED),
        (ValueError("Expecting value"), FaultKind.UNREADABLE),
    ],
)
def test_connection_decides(error: Exception, kind: FaultKind) -> None:
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


GEMINI = (
    '{"error": {"code": 429, "status": "RESOURCE_EXHAUSTED", "message": "You exceeded your current quota, please check '
    'your plan and billing details.", "details": [{"@type": "x/RetryInfo", "retryDelay": "1.5s"}]}}'
)
QUOTA = '{"error": {"message": "%s", "type": "insufficient_quota", "code": "insufficient_quota"}}'


@pytest.mark.parametrize(
    ("status", "headers", "body", "kind", "wait"),
    [
        (429, {"retry-after": "1"}, "You exceeded your current quota; see billing", FaultKind.RATE, 1.0),
        (429, {"retry-after-ms": "250"}, "quota, billing", FaultKind.RATE, 0.25),
        (429, {"retry-after": "2.5s"}, "quota, billing", FaultKind.RATE, 2.5),
        (429, {}, GEMINI, FaultKind.RATE, 1.5),
        (429, {}, "[" + GEMINI + "]", FaultKind.RATE, 1.5),
        (429, {}, "You exceeded your current quota. Please try again in 20ms.", FaultKind.RATE, 0.02),
        (429, {}, "Billing quota reached, please retry in 6m30.5s", FaultKind.RATE, 390.5),
        (429, {}, "Rate limit for billing tier: wait 3 seconds", FaultKind.RATE, 3.0),
        (429, {}, '{"message": "quota", "retry_after": 12}', FaultKind.RATE, 12.0),
        (429, {}, '{"error": {"code": "rate_limit_exceeded", "message": "billing tier 1"}}', FaultKind.RATE, None),
        (429, {}, "配额已用完", FaultKind.RATE, None),
        (429, {}, "You exceeded your current quota, please check your plan and billing details", FaultKind.QUOTA, None),
        (429, {}, QUOTA % "nix mehr da", FaultKind.QUOTA, None),
        (429, {"retry-after": "1"}, QUOTA % "x", FaultKind.QUOTA, 1.0),
        (429, {"x-ratelimit-reset-requests": "1s"}, "Kontingent; billing", FaultKind.RATE, None),
        (429, {"ratelimit-reset": "30"}, "quota, billing", FaultKind.RATE, None),
        (429, {"x-ratelimit-reset-requests": "1s"}, QUOTA % "x", FaultKind.QUOTA, None),
        (402, {}, "配额", FaultKind.QUOTA, None),
        (403, {}, QUOTA % "x", FaultKind.QUOTA, None),
        (400, {}, '{"error": {"code": "context_length_exceeded", "message": "trop long"}}', FaultKind.TOO_LONG, None),
        (400, {}, '{"error": {"code": "json_validate_failed", "message": "no"}}', FaultKind.REFUSED, None),
        (400, {}, '{"error": {"code": "model_not_found", "message": "nein"}}', FaultKind.MODEL, None),
        (501, {}, "not implemented", FaultKind.REFUSED, None),
        (503, {"retry-after": "7"}, "busy", FaultKind.SERVER, 7.0),
        (504, {}, "<html>gateway</html>", FaultKind.TIMEOUT, None),
        (429, {"retry-after": "nan"}, "x", FaultKind.RATE, None),
        (429, {"retry-after": "1e999"}, "x", FaultKind.RATE, float("inf")),
        (500, {}, "[" * 100_000, FaultKind.SERVER, None),
    ],
)
def test_code_and_named_wait_decide_before_words(
    status: int, headers: dict[str, str], body: str, kind: FaultKind, wait: float | None
) -> None:
    fault = fault_of_response(status, headers, body)
    assert (fault.kind, fault.retry_after) == (kind, wait if wait is None else pytest.approx(wait))


def test_what_the_server_says_is_taken_out_of_its_json() -> None:
    assert fault_of_response(400, {}, '{"error": {"message": "no such field"}}').detail == "400: no such field"
    assert fault_of_response(422, {}, '{"detail": [{"loc": ["x"], "msg": "extra"}]}').detail == "422: extra"
    assert fault_of_response(500, {}, "plain").detail == "500: plain"


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
