# ruff: noqa: RUF001 - quotes, colons and commas of other scripts are meant
"""JSON as models write it when they are careless, read where only one reading is possible.

Quotes of any kind, comments, unquoted keys, commas too many or too few, Python's words, and an end that
is missing. A value that the end of the text cuts off is left out: ``CAV1`` may be the beginning of ``CAV12``.
"""

import re
from contextlib import suppress
from typing import Any

_BEGUN = re.compile(r"[{\[]")
_BLANK = re.compile(r"(?:\s|//[^\n]*|#[^\n]*|/\*.*?(?:\*/|$)|<!--.*?(?:-->|$)|\.{3}|…)*", re.DOTALL)
_QUOTES = dict.fromkeys('"“”„', re.compile(r"[\"“”]")) | dict.fromkeys("'‘’`", re.compile(r"['‘’`]"))
_QUOTES |= {begin: re.compile(end) for begin, end in ("«»", "»«", "「」", "『』", "＂＂")}
_WIDE = str.maketrans("｛｝［］", "{}[]")
_COLON = re.compile(r"=>|[:=：]")
_COMMA = re.compile(r"[,;，]")
_KEY = re.compile(r"[\w.-]+")
_WORD = re.compile(r"(?:(?!\s(?://|#|/\*))[^,;，}\]{\[\n\"“”])+")
_WORDS = {"true": True, "false": False, "none": None, "null": None}
# What may follow the quote that ends a key, and the one that ends a value; any other quote stands inside the text.
_AFTER_KEY = re.compile(r"\s*(?:=>|[:=：])")
_AFTER_VALUE = re.compile(r"[ \t]*\n\s*\w+\s*[:=：]|\s+[\"“'‘]\w+[\"”'’]\s*[:=：]|\s*(?:[,;，}\]]|//|#|/\*|<!--|$)")
_ESCAPE = re.compile(r"\\(?:u([0-9a-fA-F]{4})|(.))", re.DOTALL)
_ESCAPED = {"n": "\n", "t": "\t", "r": "\n", "b": "", "f": ""}

_DEEPEST = 40
_WORK = 20_000  # Places looked at in one text, so that no text takes long


class _UnreadableError(Exception):
    """What begins here is no JSON, however carelessly written."""


class _CutOffError(Exception):
    """The text ends within a value."""


def careless_values(text: str) -> list[Any]:
    """Read the outermost objects and lists of a text; one of which nothing is left but its beginning is none."""
    text = text.translate(_WIDE)
    reader, found, start = _Reader(text), [], 0
    while (begun := _BEGUN.search(text, start)) and reader.work < _WORK:
        start = begun.start() + 1
        with suppress(_UnreadableError, _CutOffError):
            value, end = reader.value(begun.start(), _DEEPEST)
            if value:
                found.append(value)
                start = end
    return found


class _Reader:
    """Reads values of one text, each from where it begins to where it ends."""

    def __init__(self, text: str) -> None:
        self.text, self.work = text, 0

    def value(self, at: int, depth: int) -> tuple[Any, int]:
        self.work += 1
        first = self.text[at : at + 1]
        if not first:
            raise _CutOffError
        if not depth or self.work > _WORK:
            raise _UnreadableError
        if first == "{":
            return self._members(at + 1, depth)
        if first == "[":
            return self._items(at + 1, depth)
        return self._quoted(at, _AFTER_VALUE) if first in _QUOTES else self._word(at)

    def _members(self, at: int, depth: int) -> tuple[dict[str, Any], int]:
        pairs: list[tuple[str, Any]] = []
        while True:
            at = self._skip(at)
            if self.text[at : at + 1] in ("", "}"):
                return merged(pairs), at + 1
            try:
                key, at = self._key(at)
                at = self._skip(at)
                if at == len(self.text):
                    return merged(pairs), at
                if not (colon := _COLON.match(self.text, at)):
                    raise _UnreadableError
                value, at = self.value(self._skip(colon.end()), depth - 1)
            except _CutOffError:
                return merged(pairs), len(self.text)
            pairs.append((key, value))
            at = self._next(at, "}")

    def _items(self, at: int, depth: int) -> tuple[list[Any], int]:
        items: list[Any] = []
        while True:
            at = self._skip(at)
            if self.text[at : at + 1] in ("", "]"):
                return items, at + 1
            try:
                value, at = self.value(at, depth - 1)
            except _CutOffError:
                return items, len(self.text)
            items.append(value)
            at = self._next(at, "]")

    def _next(self, at: int, end: str) -> int:
        """Go past the comma after a member, which may be missing."""
        begun, at = at, self._skip(at)
        if comma := _COMMA.match(self.text, at):
            return comma.end()
        if self.text[at : at + 1] in ("", end) or at > begun:
            return at
        raise _UnreadableError

    def _key(self, at: int) -> tuple[str, int]:
        if self.text[at] in _QUOTES:
            return self._quoted(at, _AFTER_KEY)
        if not (bare := _KEY.match(self.text, at)):
            raise _UnreadableError
        return bare.group(), bare.end()

    def _quoted(self, at: int, after: re.Pattern[str]) -> tuple[str, int]:
        ends = _QUOTES[self.text[at]]
        end = at
        while found := ends.search(self.text, end + 1):
            self.work += 1
            end = found.start()
            slashes = len(self.text[at + 1 : end]) - len(self.text[at + 1 : end].rstrip("\\"))
            if slashes % 2 == 0 and after.match(self.text, end + 1):
                return _ESCAPE.sub(_plain, self.text[at + 1 : end]), end + 1
            if self.work > _WORK:
                break
        raise _CutOffError

    def _word(self, at: int) -> tuple[Any, int]:
        found = _WORD.match(self.text, at)
        if not found:
            raise _UnreadableError
        if found.end() == len(self.text):
            raise _CutOffError
        word = found.group().strip()
        if word.lower() in _WORDS:
            return _WORDS[word.lower()], found.end()
        return int(word) if re.fullmatch(r"-?\d{1,9}", word) else word, found.end()

    def _skip(self, at: int) -> int:
        found = _BLANK.match(self.text, at)
        end = found.end() if found else at
        self.work += (end - at) // 50
        return end


def merged(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Make an object of its members; of a key that is there twice with different values, all are kept as a list."""
    made: dict[str, Any] = {}
    for key, value in pairs:
        made[key] = [made[key], value] if key in made and made[key] != value else value
    return made


def _plain(escape: re.Match[str]) -> str:
    code, letter = escape.groups()
    return chr(int(code, 16)) if code else _ESCAPED.get(letter, letter)
