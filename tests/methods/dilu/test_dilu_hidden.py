"""What DiLu is told and decides does not depend on what others are, mean or do."""

import re
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from dilu_driven import NEVER_HELD, always, modelled, ruled, text
from driven import drive, ordered
from hidden import scrambled
from worlds import Junction

from codriving.datatypes.world import WorldState
from codriving.environment.environment import Environment

SCENARIOS = ("intersection", "roundabout", "highway", "merge")

Driven = Callable[[str], tuple[Junction, tuple[WorldState, ...]]]


@pytest.fixture(scope="module")
def driven(configured: Callable[..., Environment]) -> Driven:
    """A road, and what is seen there in the first 16 decisions of an episode; driven once."""

    @cache
    def once(scenario: str) -> tuple[Junction, tuple[WorldState, ...]]:
        junction = Junction(configured(f"scenario={scenario}"))
        return junction, drive(junction.environment, ordered(junction), 10_003, decisions=16).worlds

    return once


@pytest.mark.parametrize("scenario", SCENARIOS)
def test_prompts_and_decisions_do_not_depend_on_what_is_hidden(scenario: str, driven: Driven) -> None:
    (junction, worlds), rng = driven(scenario), np.random.default_rng(0)
    ego = worlds[0].cavs[0].id
    (one, first), (other, second) = (modelled(junction, always("IDLE"), hold=NEVER_HELD) for _ in range(2))
    rules = [ruled(junction, hold=NEVER_HELD) for _ in range(2)]
    for world in worlds:
        if ego not in world.intents:
            continue
        hidden = scrambled(world, ego, junction.road_map, rng)
        assert hidden != world
        one.act(world)
        other.act(hidden)
        assert rules[0].act(world).actions[ego] is rules[1].act(hidden).actions[ego]
    asked, again = ([text(q) for q in chat.questions if q.subject == ego] for chat in (first, second))
    assert len(asked) > 10
    assert asked == again


@pytest.mark.parametrize("scenario", SCENARIOS)
def test_prompts_name_no_route_but_the_own_one_and_no_vehicle_by_id(scenario: str, driven: Driven) -> None:
    junction, worlds = driven(scenario)
    made, chat = modelled(junction, always("IDLE"), hold=NEVER_HELD)
    for world in worlds[:9]:
        made.act(world)
        for question in chat.questions[-len(world.cavs) :]:
            said = text(question)
            named = {route for route in junction.road_map.routes if re.search(rf"(?<![\w-]){route}(?![\w-])", said)}
            assert named == {world.intents[question.subject].route}
            assert not re.search(r"CAV|HDV|human", said)
            assert "before you" not in said
