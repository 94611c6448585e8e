"""Pictures of an episode: a frame at any time, a film of the whole, and a live view of a world.

Places and sizes on a frame are in logical pixels, x to the right and y downwards; those of the world are in metres.
"""

from typing import TYPE_CHECKING

from codriving.animation.live import LivePicture

if TYPE_CHECKING:
    from codriving.animation.film import EpisodeFilm, Frame, write_png

__all__ = ["EpisodeFilm", "Frame", "LivePicture", "write_png"]


def __getattr__(name: str) -> object:
    """Import Matplotlib, which takes half a second, only where a film or a frame is drawn."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from codriving.animation import film

    return getattr(film, name)
