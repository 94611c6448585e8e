"""Keys out of texts: servers repeat what they were sent, and their words end up in errors, records and transcripts."""

import re
from urllib.parse import quote

HIDDEN = "***"

# What is left of a key after a server has masked the middle of it is hidden, too.
_BEARER = re.compile(r"(?i)\b(bearer|basic)\s+[^\s\"',;}]+")
_HEADER = re.compile(
    r"(?i)\b((?:proxy-)?authorization|x-api-key|api[-_]key)(\"?'?\s*[:=]\s*\"?'?)(?!bearer|basic)[^\s\"',;}]+"
)
_SECRET = re.compile(r"\bsk-[\w*.\-]{6,}|\bAIza[\w\-]{20,}")


def without_key(text: str, key: str | None) -> str:
    """Take one key out of a text, as it is and as it stands in an address.

    Args:
        key: The key; None or empty takes nothing out.
    """
    for written in {key, quote(key, safe="")} if key else ():
        text = text.replace(written, HIDDEN)
    return text


def redacted(text: str, key: str | None) -> str:
    """Take everything out of an error text that is a key or looks like one."""
    text = _BEARER.sub(rf"\1 {HIDDEN}", without_key(text, key))
    return _SECRET.sub(HIDDEN, _HEADER.sub(rf"\1\2{HIDDEN}", text))
