"""Colours, strokes and sizes: the palette of Okabe and Ito (2008), with a second cue for each colour."""

from dataclasses import dataclass

from codriving.datatypes import Action, Kind, Severity
from codriving.errors import ConfigError

# SidePanel, land, buildings, road and painted lines.
PAPER, GROUND, BUILDING, ASPHALT, PAINT = "#ffffff", "#f3f2ec", "#d8cdbd", "#cfd3d9", "#ffffff"

BAND = "90"  # Opacity of the bands along which two vehicles come together; the plans on them stay in sight

# Around words on the road.
HALO = "#ffffffc8"

# Words, words that matter less, and thin rules.
INK, FAINT, HAIR = "#1d2126", "#5d656f", "#d9dbdf"

BLUE, ORANGE, GREEN, VERMILION, SKY = "#0072b2", "#e69f00", "#009e73", "#d55e00", "#56b4e9"

KINDS = {Kind.CAV: BLUE, Kind.HDV: ORANGE}  # CAVs are filled and pointed, human drivers hollow and square

# Each has a glyph of its own shape and its name in words, too.
ACTIONS = {
    Action.FASTER: GREEN,
    Action.SLOWER: VERMILION,
    Action.IDLE: FAINT,
    Action.HOLD: FAINT,
    Action.LANE_LEFT: BLUE,
    Action.LANE_RIGHT: BLUE,
}


@dataclass(frozen=True, slots=True)
class Stroke:
    """How a conflict is drawn."""

    colour: str
    width: float  # Width of the line [px]; wider with danger
    dash: tuple[float, ...]  # Lengths of dashes and gaps [px]; shorter dashes with less danger, none for a full line
    mark: float  # Half the width of the mark [px]
    word: str
    limit: str


# The bands of danger that are drawn; beyond 8 s nothing is.
SEVERITIES = {
    Severity.SERIOUS: Stroke("#7a1f5c", 6.0, (), 9.5, "serious", "up to 2 s"),
    Severity.GENERAL: Stroke("#a83a86", 4.5, (9.0, 4.0), 8.0, "general", "up to 5 s"),
    Severity.SLIGHT: Stroke("#b86fa3", 3.5, (3.0, 4.0), 6.5, "slight", "up to 8 s"),
}


PANEL = 384.0  # Width of the panel [px]

SCALES = (0.5, 4.0)
SMALLEST, LARGEST = 240, 4096


def check_size(width: float, height: float, scale: float, panel: bool = True) -> None:
    """Refuse sizes at which nothing could be read, or that would fill the memory."""
    low = SMALLEST + (round(PANEL) if panel else 0)
    for name, value, least in (("width", width, low), ("height", height, SMALLEST)):
        if not least <= value <= LARGEST:
            raise ConfigError(f"{name} must be {least} to {LARGEST} px, got {value:g}")
    if not SCALES[0] <= scale <= SCALES[1]:
        raise ConfigError(f"scale must be {SCALES[0]:g} to {SCALES[1]:g}, got {scale:g}")
