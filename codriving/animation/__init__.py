"""Pictures of an episode: a frame at any time, a film of the whole, and a live view of a world.

Places and sizes on a frame are in logical pixels, x to the right and y downwards; those of the world are in metres.
"""

from codriving.animation.film import EpisodeFilm, Frame, write_png
from codriving.animation.live import LivePicture

__all__ = ["EpisodeFilm", "Frame", "LivePicture", "write_png"]
