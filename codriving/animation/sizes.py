"""How large a frame may be; in a file of its own, for it is checked before anything heavy is imported."""

from codriving.errors import ConfigError

PANEL = 384.0
"""Width of the panel [px]."""

SCALES = (0.5, 4.0)
SMALLEST, LARGEST = 240, 4096


def check_size(width: float, height: float, scale: float, panel: bool = True) -> None:
    """Refuse sizes at which nothing could be read, or that would fill the memory.

    Args:
        width: Width of a frame at scale 1 [px].
        height: Height of a frame at scale 1 [px].

    Raises:
        ConfigError: If one of them is out of range.
    """
    low = SMALLEST + (round(PANEL) if panel else 0)
    for name, value, least in (("width", width, low), ("height", height, SMALLEST)):
        if not least <= value <= LARGEST:
            raise ConfigError(f"{name} must be {least} to {LARGEST} px, got {value:g}")
    if not SCALES[0] <= scale <= SCALES[1]:
        raise ConfigError(f"scale must be {SCALES[0]:g} to {SCALES[1]:g}, got {scale:g}")
