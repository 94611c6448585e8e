"""Made-up variables on which every template is tried out before a run begins."""

from math import inf
from typing import Any

from codriving.llm.prompts.judging import ContestView
from codriving.llm.prompts.told import ArrivalView, BlockView, ChoiceView, HumanView, MeetingView, PastView
from codriving.llm.prompts.views import (
    ActionView,
    ConflictView,
    EntrantView,
    FixedView,
    IntentView,
    LaneView,
    MeaningView,
    OrderView,
    OtherView,
    PairView,
    SeenView,
    VehicleView,
    WayView,
)

_ENTRANTS = [
    EntrantView("CAV1", 8.0, "north-south", False, 9.0, 30.0, 3.6, True, "CAV3", ((2.0, 4.0), (6.0, 8.0))),
    EntrantView("CAV2", 6.0, "west-north", True, 6.0, 2.0, 0.3, False, "", ()),
]
_KNOWN = (VehicleView("CAV3", "CAV", 12.0, 7.0), VehicleView("HDV1", "human", 9.0, 8.0))
_SEEN = (VehicleView("V1", "unknown driver", 12.0, 7.0), VehicleView("V3", "unknown driver", 9.0, 8.0))
_WAYS = (WayView("crossing", 30.0, 12.0, 3.8, 2.0, 1.8, "serious danger"),)

_SINGLE_VEHICLE: dict[str, Any] = {
    "speed": 8.0,
    "target_speed": 9.0,
    "route": "north-south",
    "lane_rank": 1,
    "lane_count": 2,
    "between_lanes": True,
    "must_change": "LANE_RIGHT",
    "room": 40.0,
    "lanes": [LaneView("ego lane", *_SEEN), LaneView("right lane", None, None)],
    "vehicles": [
        SeenView("V2", "ahead left", 25.0, 6.0, 0.0, _WAYS, 2),
        SeenView("V4", "behind", 15.0, 0.0, 3.5, (), 1),
    ],
    "actions": [MeaningView("SLOWER", 6.0), MeaningView("IDLE", 9.0), MeaningView("LANE_RIGHT", None)],
    "allowed": ["SLOWER", "IDLE", "LANE_RIGHT"],
}

_MOVING = {
    **{"cav_speed": 8.0, "cav_distance": 29.0, "cav_time": 3.3, "cav_in_junction": 1.0, "cav_committed": 1.0},
    **{"cav_held_up": 1.0, "human_speed": 8.0, "human_acceleration": 0.0, "human_distance": 33.0, "human_time": 4.5},
    **{"human_braking": 1.1, "human_standing": 1.5, "human_in_junction": 1.0, "human_held_up": 1.0, "ways": 3.0},
    **{"priority": 0.0, "converging": 0.0, "time_ahead": 1.1, "human_occupies": 1.0, "cav_turns": 0.0},
}

# Variables of every kind by purpose: every list has an entry and every condition holds at least once.
EXAMPLES: dict[str, dict[str, Any]] = {
    "negotiate": {
        "vehicles": _ENTRANTS,
        "everyone": _ENTRANTS,
        "humans": [
            BlockView("HDV1", 8.0, (("CAV1", 0.0, 4.0), ("CAV2", 2.0, 6.0)), ("CAV3",)),
            BlockView("HDV2", 0.0, (("CAV1", 0.0, 1000.0),), ()),
            BlockView("HDV3", 8.0, (), ()),
        ],
        "norms": ["turning yields to going straight, but for one that is there 1 s earlier"],
        "thoughts": True,
        "pairs": [
            PairView(
                "p1",
                "CAV1",
                "CAV2",
                "crossing",
                (30.0, 2.0),
                (3.8, 0.3),
                3.5,
                "general danger",
                "CAV2",
                (3.6, 0.3),
                (True, False),
                (5.1, 0.0),
            ),
            PairView(
                "p2",
                "CAV2",
                "CAV3",
                "converging",
                (2.0, 20.0),
                (0.3, 2.5),
                2.2,
                "general danger",
                "",
                (0.3, 2.2),
                (False, True),
                (0.0, 3.9),
            ),
        ],
        "fixed": [FixedView("CAV3", "CAV1")],
        "binding": False,
    },
    "decide": {
        "ego": "CAV1",
        "speed": 8.0,
        "lane": "a-b/1",
        "route": "north-south",
        "target_speed": 9.0,
        "between_lanes": True,
        "must_change": "LANE_LEFT",
        "room": 40.0,
        "lanes": [LaneView("ego lane", *_KNOWN), LaneView("left lane", None, None)],
        "others": [OtherView("V1", "unknown driver", -3.0, 4.0, 8.0)],
        "conflict_lanes": ["c-d/0"],
        "conflicts": [
            ConflictView("crossing", 30.0, 2.0, 3.8, 0.3, 3.5, "general danger", "CAV2", "CAV", "c-d/0", 6.0, 1, inf),
            ConflictView("converging", 30.0, 9.0, 3.8, 1.5, 2.3, "general danger", "HDV2", "human", "", 6.0, 2, 0.0),
        ],
        "intents": [IntentView("CAV2", "west-north", 6.0)],
        "no_intents": ["HDV1"],
        "binding": False,
        "before": [OrderView("CAV2", "CAV2 can no longer stop before the conflict zone", "CAV2 can no longer stop")],
        "after": [
            OrderView("HDV2", "the CAV is through (3.6 s) before the human driver can be there", "it is through")
        ],
        "actions": [
            ActionView(("SLOWER",), True, (), 40.0, (4.2, 4.2), 6.0),
            ActionView(("IDLE",), True, ("no action is safe; this one is the least dangerous",), None, (inf,)),
            ActionView(("FASTER",), False, ("same lane: FASTER leaves too little room",), None, ()),
        ],
        "may_hold": True,
        "meetings": [
            MeetingView("CAV2", "CAV", "crossing", 3.0, 4.5, True, False, "it", True),
            MeetingView("HDV1", "human", "converging", 0.0, 2.0, False, True, "you", False),
            MeetingView("HDV2", "human", "weaving", inf, inf, False, False, "", True),
        ],
        "humans": [
            HumanView("HDV1", 8.0, 9.0, -1.5, 0.0, ("left", "straight"), "you", "", 2.5, "CAV2", 12.0, "unclear"),
            HumanView("HDV2", 8.0, None, 1.0, 0.0, ("right",), "it", "", inf, "", 0.0, ""),
            HumanView("HDV3", 0.0, 0.0, None, 3.0, ("straight",), "", "it has been standing", 0.0, "", 0.0, ""),
        ],
        "choices": [
            ChoiceView(("SLOWER",), 6.0, True, (), (ArrivalView("CAV2", 4.2),), True, (), "CAV4", 1.2, ("CAV3",), 0.6),
            ChoiceView(
                ("IDLE",), 9.0, True, ("as it is",), (ArrivalView("HDV1", inf),), False, ("HDV1",), "", 0.0, (), 0.0
            ),
            ChoiceView(
                ("HOLD",), 8.0, True, (), (ArrivalView("HDV1", 3.0),), False, (), "", 0.0, ("CAV2", "CAV3"), inf
            ),
            ChoiceView(("FASTER",), None, False, ("too little room",), (), False, (), "", 0.0, (), 0.0),
        ],
        "norms": ["a lane ends beside yours"],
        "past": PastView("SLOWER", "CAV2 goes first.", "Go after CAV2.", 2, ("CAV3 now goes before you",)),
        "thoughts": True,
        "memories": ["Slowing down early let CAV2 pass without a stop."],
        "allowed": ["SLOWER", "IDLE"],
    },
    "reflect": {
        "scene": "Driving 8.0 m/s, target 9.0 m/s; no vehicle ahead on the lane.",
        "conflict": "Crossing conflict with a human vehicle: dTTCP 3.0 s, general danger.",
        "order": "The CAV goes second; 1 go before it.",
        "met": "At 8.0 m/s, crossing with human, 20 m and 2.5 s before the zone, it 24 m and 5.5 s, second.",
        "action": "FASTER",
        "verdict": "intensified",
        "comment": "Your action has intensified the conflict; similar actions should be avoided.",
        "dttcp_before": 3.0,
        "dttcp_after": 1.2,
        "own_change": -1.5,
        "own_braking": 4.2,
        "forced_braking": 4.5,
        "collision": 2.5,
        "needless": True,
    },
    "judge": {
        "pairs": [
            ContestView(
                "p1", "CAV1", "HDV1", {**_MOVING, "human_acceleration": -1.2, "priority": 1.0}, "it waits", "", "3 of 8"
            ),
            ContestView("p2", "CAV1", "HDV2", {**_MOVING, "human_acceleration": 1.0, "priority": -1.0}, "", "HDV3"),
            ContestView("p3", "CAV2", "HDV3", {**_MOVING, "human_speed": 0.0, "ways": 1.0, "converging": 1.0}, "", ""),
        ]
    },
    "dilu": {**_SINGLE_VEHICLE, "interval": 1.0, "memories": ["At 8.0 m/s, no conflict: FASTER. No mistake."]},
    "dilu_reflect": {
        **_SINGLE_VEHICLE,
        **{"action": "IDLE", "reason": "no vehicle is near", "struck": True, "other": "V2", "later": 1.5},
    },
}
