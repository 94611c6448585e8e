"""The target speed that an assessment names is the one that the simulator sets."""

import pytest
from worlds import Junction, car

from codriving.datatypes.world import Action, Kind, Start
from codriving.reasoning.safety.assessment import ThreeLayers


@pytest.mark.parametrize("speed", [0.0, 1.4, 1.6, 3.0, 5.9, 7.4, 7.6, 9.0])
@pytest.mark.parametrize("before", [None, Action.FASTER, Action.SLOWER])
def test_an_action_sets_the_target_that_is_told(speed: float, before: Action | None, junction: Junction) -> None:
    for action in (Action.SLOWER, Action.IDLE, Action.FASTER):
        environment = junction.drive(Start("CAV1", Kind.CAV, "south-north", 20.0, speed))
        world = environment.reset(0)
        if before is not None:
            world = environment.step({"CAV1": before})
        now, target = world.cavs[0].speed, world.intents["CAV1"].target_speed
        given = junction.safety_input(car("CAV1", "south-north", 25.0, now, target=target))
        told = {a.action: a.target for a in ThreeLayers().assess(given)}
        assert environment.step({"CAV1": action}).intents["CAV1"].target_speed == told[action]


def test_faster_and_slower_step_from_the_speed_and_not_from_the_target(junction: Junction) -> None:
    assert junction.model.target_speeds == (0.0, 3.0, 6.0, 9.0)
    for speed, target, slower, faster in ((6.2, 9.0, 3.0, 9.0), (2.9, 9.0, 0.0, 6.0), (8.9, 0.0, 6.0, 9.0)):
        assert junction.model.target_after(Action.SLOWER, speed, target) == slower
        assert junction.model.target_after(Action.FASTER, speed, target) == faster
        assert junction.model.target_after(Action.IDLE, speed, target) == target
        assert junction.model.target_after(Action.LANE_LEFT, speed, target) is None
