"""The whole method in every scenario, on seeds that nothing was tuned on."""

from collections.abc import Callable

import pytest
from thorough import some

from codriving.datatypes.record import Ending
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment
from codriving.llm.language_model import Offline
from codriving.methods.codriving import CoDriving
from codriving.reasoning.sharing.sharing import CdaLevel

Make = Callable[..., Environment]
CHANGES = {Action.LANE_LEFT, Action.LANE_RIGHT}


def drive(environment: Environment, seed: int) -> dict[str, list[tuple[Action, str]]]:
    """Drive one episode that must succeed; return what each CAV did, and on which route it was then."""
    method = CoDriving(CdaLevel(True, True, True, True, False, "own_view"), Offline(), None, 1.5)
    world = environment.reset(seed)
    method.reset(environment.road_map, environment.driving_model, seed)
    done: dict[str, list[tuple[Action, str]]] = {cav.id: [] for cav in world.cavs}
    while environment.outcome is None:
        actions = method.act(world).actions
        for name, action in actions.items():
            done[name].append((action, world.intents[name].route))
        world = environment.step(actions)
    assert environment.outcome.ending is Ending.SUCCESS, environment.outcome
    assert set(environment.outcome.arrivals) == set(done)
    return done


@pytest.mark.parametrize("seed", some(1, [10_001, 20_002]))
@pytest.mark.parametrize("scenario", ["intersection", "roundabout"])
def test_where_ways_cross_or_meet_every_vehicle_arrives_without_changing_lanes(
    scenario: str, seed: int, configured: Make
) -> None:
    for steps in drive(configured(f"scenario={scenario}"), seed).values():
        assert not CHANGES & {action for action, _ in steps}
        assert len({route for _, route in steps}) == 1


@pytest.mark.parametrize("seed", some(1, [10_001, 20_010]))
def test_on_the_highway_slower_drivers_are_overtaken(seed: int, configured: Make) -> None:
    done = drive(configured("scenario=highway"), seed)
    changed = {name: {route for _, route in steps} for name, steps in done.items()}
    assert any(CHANGES & {action for action, _ in steps} for steps in done.values())
    assert any(len(routes) > 1 for routes in changed.values())


@pytest.mark.parametrize("seed", some(1, [10_001, 20_002, 30_003]))
def test_at_the_merge_every_cav_leaves_the_ramp(seed: int, configured: Make) -> None:
    done = drive(configured("scenario=merge"), seed)
    from_ramp = {name: steps for name, steps in done.items() if steps[0][1] == "ramp"}
    assert len(from_ramp) == 3
    for steps in from_ramp.values():
        assert (Action.LANE_LEFT, "ramp") in steps
        assert steps[-1][1].startswith("main")
