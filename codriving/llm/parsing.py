"""Texts from outside, made harmless: short, on one line, without what a terminal or a file should not be given."""

import re

LONGEST = 20_000  # More of an answer is neither read nor written down [characters]

_LEFT_OUT = " ... "

# Control and direction characters, and halves of surrogate pairs, which no file can hold; line ends and tabs stay.
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2066-\u2069\ufeff\ud800-\udfff]")
_PAGE = re.compile(r"(?is)^\s*(?:<\?xml[^>]*>\s*)?<(?:!doctype html|html|head|body)\b")


def clean(text: str, longest: int = LONGEST) -> str:
    """Cap a text and take out the characters that neither a file nor a terminal should be given.

    What is too long loses its middle: an answer may stand at either end.
    """
    if len(text) > longest:
        half = longest // 2
        text = f"{text[:half]}{_LEFT_OUT}{text[-half:]}"
    return _CONTROL.sub("", text.replace("\r\n", "\n").replace("\r", "\n"))


def one_line(text: str, longest: int) -> str:
    """Put a text on one line and shorten it.

    Args:
        longest: Where it is cut [characters].
    """
    line = " ".join(clean(text).split())
    return line if len(line) <= longest else f"{line[: longest - 3]}..."


def is_page(text: str) -> bool:
    """Whether a text is a web page, as proxies and login portals send it."""
    return bool(_PAGE.match(text))
