"""What the prompts of DiLu are made of: what one vehicle sees alone, and what the map says of it."""

from dataclasses import dataclass
from typing import Any

from codriving.llm.prompts.views import LaneView, VehicleView


@dataclass(frozen=True, slots=True)
class WayView:
    """One way that a vehicle may take, where it meets that of the CAV.

    Attributes:
        mine: The CAV's distance to the place where they meet [m].
        its: The other's distance to it [m].
        my_ttcp: The CAV's time to it at its present speed [s].
        its_ttcp: The other's time to it [s].
        dttcp: Difference of the two [s].
    """

    relation: str
    mine: float
    its: float
    my_ttcp: float
    its_ttcp: float
    dttcp: float
    severity: str


@dataclass(frozen=True, slots=True)
class SeenView:
    """A vehicle as the CAV sees it; who drives it and where it goes is not known.

    Attributes:
        where: Where it is seen from the CAV, for instance ``ahead left``.
        distance: Distance of the centres [m].
        speed: Its speed [m/s].
        standing: How long it has been standing [s].
    """

    id: str
    where: str
    distance: float
    speed: float
    standing: float
    ways: tuple[WayView, ...]
    elsewhere: int


@dataclass(frozen=True, slots=True)
class MeaningView:
    """An action that the road allows.

    Attributes:
        target: Target speed after it [m/s]; None for a lane change.
    """

    name: str
    target: float | None


def seen_example(purpose: str) -> dict[str, Any]:
    """Return made-up variables of every kind, for the templates of DiLu to be tried out on.

    Args:
        purpose: ``dilu`` or ``dilu_reflect``.
    """
    ahead, behind = VehicleView("V1", "unknown driver", 12.0, 7.0), VehicleView("V3", "unknown driver", 9.0, 8.0)
    crossing = WayView("crossing", 30.0, 12.0, 3.8, 2.0, 1.8, "serious danger")
    told: dict[str, Any] = {
        "speed": 8.0,
        "target_speed": 9.0,
        "route": "north-south",
        "lane_rank": 1,
        "lane_count": 2,
        "between_lanes": True,
        "must_change": "LANE_RIGHT",
        "room": 40.0,
        "lanes": [LaneView("ego lane", ahead, behind), LaneView("right lane", None, None)],
        "vehicles": [
            SeenView("V2", "ahead left", 25.0, 6.0, 0.0, (crossing,), 2),
            SeenView("V4", "behind", 15.0, 0.0, 3.5, (), 1),
        ],
        "actions": [MeaningView("SLOWER", 6.0), MeaningView("IDLE", 9.0), MeaningView("LANE_RIGHT", None)],
        "allowed": ["SLOWER", "IDLE", "LANE_RIGHT"],
    }
    if purpose == "dilu":
        return {**told, "interval": 1.0, "memories": ["At 8.0 m/s, no conflict: FASTER. No mistake."]}
    return {**told, "action": "IDLE", "reason": "nobody is near", "struck": True, "other": "V2", "later": 1.5}
