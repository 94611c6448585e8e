"""Human drivers who tell their routes."""

from dataclasses import replace

import pytest
from hearing import Radio, channel_settings
from worlds import Junction, car

from codriving.datatypes.parts import Shares
from codriving.datatypes.world import WorldState
from codriving.reasoning.conflicts import find_conflicts
from codriving.v2x.draws import tells
from codriving.v2x.messages import CooperativeAwareness, RouteSharing

# The driver may still turn or go straight on; CAV1 sees it.
EGO, HUMAN = car("CAV1", "west-east", 78.0, 8.0), car("HDV1", "south-north", 78.0, 8.0)
ROUTES = {"HDV1": "south-north"}


def heard(junction: Junction, share: float, shares: Shares | None = None) -> tuple[Radio, WorldState]:
    """What CAV1 knows 0.1 s after the driver has told its route, if it does."""
    radio = Radio(
        junction, channel_settings(age=0.1, telling_humans=share), shares or Shares(states=True, intents=True)
    )
    radio.channel.hear(replace(radio.world(0.0, EGO, HUMAN), routes=ROUTES))
    return radio, radio.look(0.1, EGO, HUMAN)


@pytest.mark.parametrize(("share", "certain"), [(1.0, {True}), (0.0, {False})])
def test_a_conflict_with_one_who_tells_is_certain(junction: Junction, share: float, certain: set[bool]) -> None:
    _, known = heard(junction, share)
    [scene] = [s for s in junction.think(known).scenes.values() if s.ego.id == "CAV1"]
    [human] = scene.neighbours
    assert human.intent is None
    assert not human.is_cav
    assert {c.certain for c in find_conflicts(scene, junction.road_map)} == certain
    assert {route for route, _ in human.routes} == ({"south-north"} if share else {r for r, _ in human.routes})
    assert len(human.routes) == (1 if share else 3)


def test_a_driver_tells_state_and_route_as_far_as_that_is_shared(junction: Junction) -> None:
    for shares, kinds in (
        (Shares(states=True, intents=True), (CooperativeAwareness, RouteSharing)),
        (Shares(states=True), (CooperativeAwareness,)),
    ):
        radio, _ = heard(junction, 1.0, shares)
        packet = next(p for p in radio.channel.received("CAV1", 0.1) if p.sender == "HDV1")
        assert tuple(type(message) for message in packet.messages) == kinds
        assert [message.size for message in packet.messages] == [350, 300][: len(kinds)]


def test_one_out_of_sight_is_known_by_what_it_tells(junction: Junction) -> None:
    far = car("HDV1", "south-north", 10.0, 8.0)
    radio = Radio(junction, channel_settings(age=0.5, telling_humans=1.0))
    radio.channel.hear(replace(radio.world(0.0, EGO, far), routes=ROUTES))
    known = radio.look(0.5, EGO, far)
    human = next(v for v in known.vehicles if v.id == "HDV1")
    # It has gone on along its route: 4 m in 0.5 s.
    place, side = junction.road_map.project("south-north", human.x, human.y)
    assert (place, side) == (pytest.approx(14.0), pytest.approx(0.0))
    assert (known.told["HDV1"].age, known.told["HDV1"].intent_age, known.told["HDV1"].seen) == (0.5, 0.5, False)
    assert "HDV1" not in known.intents
    # What was told 3 s ago is forgotten.
    assert [v.id for v in radio.look(3.01, EGO, far).vehicles] == ["CAV1"]


def test_only_an_observer_is_shown_routes(junction: Junction) -> None:
    radio = Radio(junction, channel_settings(telling_humans=1.0))
    radio.send(0.0, EGO, HUMAN)
    assert [p.sender for p in radio.channel.received("CAV1", 0.1)] == []


def test_who_tells_is_drawn_for_each_driver_and_more_tell_at_a_larger_share() -> None:
    few, many = ({k for k in range(2000) if tells(7, f"HDV{k}", share)} for share in (0.3, 0.6))
    assert few < many
    assert 520 < len(few) < 680
    assert 1110 < len(many) < 1290
    assert {k for k in range(2000) if tells(8, f"HDV{k}", 0.3)} != few
    assert not any(tells(7, f"HDV{k}", 0.0) for k in range(100))
