"""Words made to fit: shortened to a line, or wrapped into a few."""

from codriving.animation.canvas import Canvas


def shortened(canvas: Canvas, words: str, size: float, room: float, bold: bool = False) -> str:
    """Cut a text so that it fits into a line, and show that it was cut.

    Args:
        size: Size of the letters [px].
        room: Width of the line [px].
    """
    words = " ".join(words.split())
    if canvas.width_of(words, size, bold) <= room:
        return words
    low, high = 0, len(words)
    while low < high:
        middle = (low + high + 1) // 2
        if canvas.width_of(words[:middle].rstrip() + "…", size, bold) <= room:
            low = middle
        else:
            high = middle - 1
    return words[:low].rstrip() + "…"


def wrapped(canvas: Canvas, words: str, size: float, room: float, lines: int) -> list[str]:
    """Break a text into at most so many lines; the last is cut if there is more.

    Args:
        size: Size of the letters [px].
        room: Width of a line [px].
    """
    rest, broken = words.split(), list[str]()
    while rest and len(broken) < lines - 1:
        line = rest.pop(0)
        while rest and canvas.width_of(f"{line} {rest[0]}", size) <= room:
            line += " " + rest.pop(0)
        broken.append(shortened(canvas, line, size, room))
    if rest and lines > 0:
        broken.append(shortened(canvas, " ".join(rest), size, room))
    return broken
