"""A table within the width of a terminal: in fewer columns or upright, so that no word and no number is broken."""

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import zip_longest

GAP = "  "  # Between two columns

HEAD_LINES = 2  # Most lines of a head

METHOD = "method"  # Head of the column of methods with their variants

PAPER = "paper: "  # What a row of the paper begins with

_NARROWEST = 14  # Characters that a column of words keeps, if it has as many


@dataclass(frozen=True, slots=True)
class Drawn:
    """A column as it may be drawn."""

    head: str
    cells: tuple[str, ...]
    words: bool = False  # Whether it stands left
    rank: int = 0  # When it gives way: the highest first, 0 never
    brief: tuple[str, str] | None = None  # Head of its short form, and the text before which a cell is cut then

    @property
    def shortened(self) -> "Drawn":
        """The column in its short form."""
        if self.brief is None:
            return self._variants() if self.head == METHOD else self
        head, end = self.brief
        return replace(self, head=head, cells=tuple(cell.partition(end)[0] for cell in self.cells), brief=None)

    def _variants(self) -> "Drawn":
        """Methods that are variants of one: its name stands in the head alone."""
        ours = [cell for cell in self.cells if not cell.startswith(PAPER)]
        name = ours[0].partition(" ")[0] if ours else ""
        if len(ours) < 2 or not all(cell.startswith(f"{name} ") for cell in ours):
            return self
        cells = tuple(cell.removeprefix(f"{name} ") for cell in self.cells)
        return replace(self, head=f"variant of {name}", cells=cells)


@dataclass(frozen=True, slots=True)
class Fitted:
    """Columns that fit, with their widths, and the heads of those that do not."""

    columns: tuple[Drawn, ...]
    widths: tuple[int, ...]
    left_out: tuple[str, ...] = ()
    cut: tuple[str, ...] = ()  # Heads of those of whose cells the first value alone is shown

    def head(self) -> list[str]:
        """Draw the heads, the last line of each at the bottom."""
        heads = [wrapped(column.head, width) for column, width in zip(self.columns, self.widths, strict=True)]
        deepest = max(map(len, heads))
        return self._lines([[*[""] * (deepest - len(lines)), *lines] for lines in heads])

    def row(self, index: int) -> list[str]:
        """Draw a row; words may take several lines."""
        return self._lines(
            [wrapped(c.cells[index], width) or [""] for c, width in zip(self.columns, self.widths, strict=True)]
        )

    @property
    def width(self) -> int:
        """Characters of a line."""
        return _width(self.widths)

    def _lines(self, cells: Sequence[Sequence[str]]) -> list[str]:
        lines = []
        for line in range(max(map(len, cells))):
            texts = [cell[line] if line < len(cell) else "" for cell in cells]
            drawn = [
                text.ljust(width) if column.words else text.rjust(width)
                for column, text, width in zip(self.columns, texts, self.widths, strict=True)
            ]
            lines.append(GAP.join(drawn).rstrip())
        return lines


def fit(columns: Sequence[Drawn], room: int) -> Fitted | None:
    """Fit columns into a width: all of them, or the most important ones in their short forms.

    Returns:
        None if what tells the rows apart does not fit, not even with wrapped words.
    """
    if widths := _widths(columns, room):
        return Fitted(tuple(columns), tuple(widths))
    short = [column.shortened for column in columns]
    kept = [index for index, column in enumerate(short) if not column.rank]
    for added in sorted((i for i, column in enumerate(short) if column.rank), key=lambda i: short[i].rank):
        more = sorted([*kept, added])
        if _widths([short[i] for i in more], room):
            kept = more
    shown = [short[i] for i in kept]
    narrow = _widths(shown, room) or _widths(shown, room, wrap_labels=True)
    left_out = tuple(column.head for i, column in enumerate(columns) if i not in kept)
    cut = tuple(columns[i].head for i in kept if columns[i].brief and columns[i].cells != short[i].cells)
    return Fitted(tuple(shown), tuple(narrow), left_out, cut) if narrow else None


def upright(columns: Sequence[Drawn], room: int) -> Fitted | None:
    """Turn a table of few rows on its side: a line for each column; None if that does not fit."""
    first, *others = columns
    heads = Drawn("", tuple(column.head for column in others), words=True)
    rows = [Drawn(name, tuple(column.cells[index] for column in others)) for index, name in enumerate(first.cells)]
    whole = [max(map(len, (column.head, *column.cells))) for column in (heads, *rows)]
    widths = whole if _width(whole) <= room else _widths([heads, *rows], room)
    return None if widths is None else Fitted((heads, *rows), tuple(widths))


def record(columns: Sequence[Drawn], index: int, room: int) -> list[str]:
    """Draw one row as a block of lines: heads and values."""
    width = min(max(len(column.head) for column in columns), room // 2)
    lines = []
    for column in columns:
        head, text = textwrap.wrap(column.head, width), column.cells[index]
        beside = room - width - len(GAP)
        if max(map(len, text.split()), default=0) > beside:
            # A long name gets lines of its own; what is longer than a line can only be broken.
            lines += [*head, *textwrap.wrap(text, room, initial_indent=GAP, subsequent_indent=GAP)]
        elif text:
            value = wrapped(text, beside)
            lines += [f"{n:<{width}}{GAP}{v}".rstrip() for n, v in zip_longest(head, value, fillvalue="")]
    return lines


wrapped = partial(textwrap.wrap, break_long_words=False, break_on_hyphens=False)


def _width(widths: Sequence[int]) -> int:
    return sum(widths) + len(GAP) * (len(widths) - 1)


def _widths(columns: Sequence[Drawn], room: int, wrap_labels: bool = False) -> list[int] | None:
    """Share a width among columns; None if it is too small."""
    widths = [max(_head_width(column.head), *map(len, column.cells)) for column in columns]
    least = [_least(column, width, wrap_labels) for column, width in zip(columns, widths, strict=True)]
    while _width(widths) > room and widths != least:
        widest = max(range(len(widths)), key=lambda index: widths[index] - least[index])
        widths[widest] -= 1
    return widths if _width(widths) <= room else None


def _least(column: Drawn, whole: int, wrap_labels: bool) -> int:
    """The least width of a column: words may be wrapped, those that tell rows apart only as a last resort."""
    if not column.words or not (column.rank or wrap_labels):
        return whole
    longest = max(len(word) for text in (column.head, *column.cells) for word in text.split() or [""])
    return max(longest, min(whole, _NARROWEST) if column.rank else 0)


def _head_width(head: str) -> int:
    """The least width at which a head takes no more than two lines."""
    least = max(map(len, head.split()), default=0)
    return next(width for width in range(least, len(head) + 1) if len(wrapped(head, max(width, 1))) <= HEAD_LINES)
