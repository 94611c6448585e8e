"""No key gets out, in whatever form a server repeats it."""

import pytest

from codriving.llm.redact import redacted

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
