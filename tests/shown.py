"""The moments on which prompts are shown as pages, and where these pages are."""

from pathlib import Path

from worlds import Car, car

GOLDEN = Path(__file__).parent / "reasoning" / "golden"
WRITE = "WRITE_GOLDEN"
"""Set this environment variable and run the tests to write the golden files anew."""

WORLDS: dict[str, tuple[Car, ...]] = {
    "intersection": (
        car("CAV1", "south-north", 70, 8, 9),
        car("CAV2", "west-south", 64, 6),
        car("CAV3", "north-east", 68, 7, 6),
        car("CAV4", "south-east", 42, 8, 9),
        car("HDV1", "west-east", 30, 8),
    ),
    "roundabout": (
        car("CAV1", "south-north", 90, 8, 9),
        car("CAV2", "west-east", 84, 6),
        car("CAV3", "south-east", 62, 9),
        car("CAV4", "north-south", 70, 7, 6),
        car("HDV1", "east-west", 80, 7),
    ),
    "merge": (
        car("CAV1", "main-1", 150, 20),
        car("CAV2", "main-0", 146, 20),
        car("CAV3", "ramp", 140, 18, 20),
        car("CAV4", "ramp", 105, 18, 20),
        car("HDV1", "main-1", 195, 17),
    ),
    "highway": (
        car("CAV1", "lane-1", 100, 25),
        car("CAV2", "lane-2", 96, 28, 30),
        car("CAV3", "lane-1", 60, 27, 25),
        car("CAV4", "lane-0", 130, 24, 25),
        car("HDV1", "lane-1", 135, 19),
        car("HDV2", "lane-3", 100, 21),
    ),
}
