"""Pictures of an episode: a frame at any moment, a film of the whole, and a live view of a world."""

from codriving.animation.live import LivePicture

__all__ = ["LivePicture"]
