"""Pictures of an episode: a frame at any time, a film of the whole, and a live view of a world.

Places and sizes on a frame are in logical pixels, x to the right and y downwards; those of the world are in metres.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from codriving.animation.content import deliberated
from codriving.animation.live import LivePicture
from codriving.animation.reading import list_in, map_in, maps_in, number_in, text_in, texts_in
from codriving.animation.talk import Talk

if TYPE_CHECKING:
    from codriving.animation.film import EpisodeFilm, Frame, write_png
    from codriving.animation.ground import ground_shapes
    from codriving.animation.picture import sentence

__all__ = [
    "EpisodeFilm", "Frame", "LivePicture", "Talk", "deliberated", "ground_shapes", "list_in", "map_in", "maps_in",
    "number_in", "sentence", "text_in", "texts_in", "write_png",
]  # fmt: skip

_DRAWN = {"ground_shapes": "ground", "sentence": "picture"}


def __getattr__(name: str) -> object:
    """Import Matplotlib, which takes half a second, only where a film or a frame is drawn."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"codriving.animation.{_DRAWN.get(name, 'film')}"), name)
