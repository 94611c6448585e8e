"""Room for words: where on the frame nothing is covered by them."""

from collections.abc import Sequence

from codriving.animation.window import Area


class Space:
    """What is taken of a part of the frame.

    Args:
        frame: The part [px]; words never leave it.
    """

    def __init__(self, frame: Area) -> None:
        self._frame = frame
        self._taken: list[Area] = []

    def take(self, area: Area) -> None:
        """Let nothing be written here, if it can be helped.

        Args:
            area: What is taken [px].
        """
        self._taken.append(area)

    def find(self, options: Sequence[Area]) -> Area:
        """Take the first place that covers nothing, or the one that covers least.

        Args:
            options: Places, the best first [px].
        """
        best, least = self._inside(options[0]), float("inf")
        for option in options:
            place = self._inside(option)
            cost = sum(overlap(place, other) for other in self._taken)
            if cost < least:
                best, least = place, cost
            if cost == 0:
                break
        self._taken.append(best)
        return best

    def _inside(self, area: Area) -> Area:
        frame = self._frame
        left = max(min(area.left, frame.left + frame.width - area.width - 2), frame.left + 2)
        top = max(min(area.top, frame.top + frame.height - area.height - 2), frame.top + 2)
        return Area(left, top, area.width, area.height)


def overlap(a: Area, b: Area) -> float:
    """Return how much two areas have in common [px²]."""
    across = min(a.left + a.width, b.left + b.width) - max(a.left, b.left)
    down = min(a.top + a.height, b.top + b.height) - max(a.top, b.top)
    return max(across, 0.0) * max(down, 0.0)


def beside(own: Area, width: float, height: float) -> list[Area]:
    """Return the places around something, first those where people look first.

    Args:
        own: What is written at [px].
        width: Width of the words [px].
        height: Their height [px].
    """
    (x, y), right, bottom = own.centre, own.left + own.width, own.top + own.height
    over = [
        Area(x - width / 2, own.top - height - 1, width, height),
        Area(x - width / 2, bottom + 1, width, height),
    ]
    sides = [Area(right + 3, y - height / 2, width, height), Area(own.left - width - 3, y - height / 2, width, height)]
    further = [
        Area(left, top, width, height)
        for top in (own.top - 2 * height - 1, bottom + height + 1)
        for left in (x - width / 2, right + 3, own.left - width - 3)
    ]
    # What stands upright on the frame leaves its sides free.
    return [*(sides + over if own.height > own.width else over + sides), *further]
