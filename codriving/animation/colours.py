"""Colours by their hexadecimal names."""

from functools import lru_cache


@lru_cache(maxsize=256)
def rgba(colour: str) -> tuple[float, float, float, float]:
    """Return red, green, blue and opacity, each 0 to 1.

    Args:
        colour: ``#rrggbb`` or ``#rrggbbaa``.
    """
    digits = colour.removeprefix("#").ljust(8, "f")
    red, green, blue, alpha = (int(digits[k : k + 2], 16) / 255 for k in (0, 2, 4, 6))
    return red, green, blue, alpha
