"""What the built-in rules say of their choice: a table from a situation to the sentence."""

import pytest
from worlds import Junction, car, order_of

from codriving.datatypes.situation import ActionAssessment, Situation
from codriving.datatypes.world import Action
from codriving.reasoning.decision.rules import decide_one

ALONE, BEHIND_CAV2, BEHIND_BOTH = (), ("CAV2 CAV1",), ("CAV2 CAV1", "HDV1 CAV1", "CAV1 CAV3")


@pytest.mark.parametrize(
    ("gains", "order", "speed", "sentence"),
    [
        # How far an action gets CAV1 within 10 s [m]; "-" keeps no order. What is not named is not safe.
        ("FASTER 80 IDLE 70", ALONE, 6.0, "no vehicle goes first and accelerating is safe"),
        ("IDLE 80 SLOWER 70", ALONE, 6.0, "no vehicle goes first, and IDLE is the fastest action that is safe"),
        ("SLOWER 80", ALONE, 6.0, "no vehicle goes first, and SLOWER is the fastest action that is safe"),
        (
            "FASTER 40 IDLE 80 SLOWER 70",
            ALONE,
            6.0,
            "no vehicle goes first, and IDLE gets farther in the end behind those ahead",
        ),
        ("FASTER 80 IDLE 70", BEHIND_CAV2, 6.0, "FASTER still lets CAV2 pass first"),
        ("FASTER 40 IDLE 80", BEHIND_BOTH, 6.0, "IDLE still lets CAV2, HDV1 pass first"),
        (
            "FASTER - IDLE -",
            BEHIND_CAV2,
            6.0,
            "the order cannot be kept with CAV2; IDLE is the slowest action that is safe",
        ),
        (
            "FASTER - IDLE -",
            BEHIND_CAV2,
            0.4,
            "the order cannot be kept with CAV2; FASTER is the fastest action that is safe",
        ),
        (
            "FASTER - IDLE -",
            ALONE,
            0.6,
            "the order cannot be kept with others; IDLE is the slowest action that is safe",
        ),
        ("LANE_LEFT -", ALONE, 6.0, "the only action that the safety check left"),
        ("LANE_LEFT 106 IDLE 100", ALONE, 6.0, "LANE_LEFT gets 6 m farther than staying"),
        ("LANE_LEFT 105 IDLE 100", ALONE, 6.0, "no vehicle goes first, and IDLE is the fastest action that is safe"),
    ],
)
def test_the_sentence_says_why(
    gains: str, order: tuple[str, ...], speed: float, sentence: str, junction: Junction
) -> None:
    words = gains.split()
    made = tuple(
        ActionAssessment(Action(name), True, (), (), None if gain == "-" else float(gain))
        for name, gain in zip(words[::2], words[1::2], strict=True)
    )
    scene = junction.thoughts(car("CAV1", "south-north", 60.0, speed)).scenes["CAV1"]
    assert decide_one(Situation(scene, (), order_of(*order), (), made)).reason == sentence
