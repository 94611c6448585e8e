"""What is sent, and what of it has reached whom."""

import math

import pytest
from hearing import Radio, channel_settings
from hypothesis import given
from hypothesis import strategies as st
from worlds import Car, Junction, car

from codriving.datatypes.parts import Shares
from codriving.v2x.channel import Packet
from codriving.v2x.draws import Link
from codriving.v2x.messages import CollectivePerception, CooperativeAwareness, ManoeuvreCoordination

# 140 m apart, and a human driver that CAV2 alone sees.
CAV1 = car("CAV1", "south-north", 30.0, 8.0)
CAV2 = car("CAV2", "south-north", 170.0, 6.0, 9.0)
HDV1 = car("HDV1", "south-north", 150.0, 4.0)


def packets(radio: Radio, time: float) -> list[Packet]:
    """What has reached CAV1."""
    return radio.channel.received("CAV1", time)


def test_messages_hold_what_the_sender_knows(junction: Junction) -> None:
    radio = Radio(junction)
    world = radio.send(0.0, CAV1, CAV2, HDV1)
    (packet,) = packets(radio, 0.0)
    state, objects, intent = packet.messages
    assert isinstance(state, CooperativeAwareness)
    assert isinstance(objects, CollectivePerception)
    assert isinstance(intent, ManoeuvreCoordination)
    assert {(m.sender, m.time, m.validity) for m in packet.messages} == {("CAV2", 0.0, 3.0)}
    by_id = {v.id: v for v in world.vehicles}
    assert state.state == by_id["CAV2"]
    assert [seen.state for seen in objects.objects] == [by_id["HDV1"]]
    assert (intent.intent, intent.available) == (world.intents["CAV2"], world.available["CAV2"])
    assert [m.size for m in packet.messages] == [350, 275, 300]
    # CAV1 sees no other vehicle.
    assert (radio.channel.messages, radio.channel.bytes) == (6, 350 + 275 + 300 + 350 + 240 + 300)


def test_what_a_building_hides_from_the_sender_it_does_not_tell(junction: Junction) -> None:
    radio = Radio(junction)
    radio.send(0.0, CAV1, CAV2, HDV1, hidden=(("CAV2", "HDV1"),))
    objects = packets(radio, 0.0)[0].messages[1]
    assert isinstance(objects, CollectivePerception)
    assert objects.objects == ()


@pytest.mark.parametrize(
    ("shares", "kinds"),
    [
        (Shares(states=True), (CooperativeAwareness, CollectivePerception)),
        (Shares(intents=True), (ManoeuvreCoordination,)),
        (Shares(), ()),
    ],
)
def test_only_what_is_shared_is_sent(junction: Junction, shares: Shares, kinds: tuple[type, ...]) -> None:
    radio = Radio(junction, shares=shares)
    radio.send(0.0, CAV1, CAV2)
    assert tuple(type(message) for message in packets(radio, 0.0)[0].messages) == kinds


def test_messages_are_sent_at_their_rate_however_often_the_world_is_shown(junction: Junction) -> None:
    radio = Radio(junction, channel_settings(rate=2.0))
    for step in range(31):
        radio.send(step / 15, CAV1, CAV2)
        radio.send(step / 15, CAV1, CAV2)
    # At 0.0, 0.5, 1.0, 1.5 and 2.0 s: three messages of each of two CAVs.
    assert radio.channel.messages == 5 * 3 * 2
    assert packets(radio, 2.0)[0].time == 2.0


@pytest.mark.parametrize(("reach", "heard"), [(139.9, 0), (140.1, 1)])
def test_the_range_ends_where_it_is_set(junction: Junction, reach: float, heard: int) -> None:
    radio = Radio(junction, channel_settings(range=reach))
    radio.send(0.0, CAV1, CAV2)
    assert len(packets(radio, 0.0)) == heard


@pytest.mark.parametrize(("time", "heard"), [(0.0, 0), (0.39, 0), (0.4, 1), (2.0, 1), (2.01, 0)])
def test_a_message_is_there_from_its_arrival_to_the_end_of_its_validity(
    junction: Junction, time: float, heard: int
) -> None:
    radio = Radio(junction, channel_settings(age=0.4, validity=2.0))
    radio.send(0.0, CAV1, CAV2)
    assert len(packets(radio, time)) == heard


def test_of_what_has_arrived_the_newest_is_used_also_if_it_overtook(
    junction: Junction, monkeypatch: pytest.MonkeyPatch
) -> None:
    delays = {0: 0.1, 1: 0.9, 2: 0.2, 3: math.inf}
    monkeypatch.setattr(Link, "delay", lambda self, tick: delays[tick])
    radio = Radio(junction)
    for tick in delays:
        radio.send(tick / 10, CAV1, CAV2)
    at = {time: [p.time for p in packets(radio, time)] for time in (0.05, 0.1, 0.35, 0.4, 1.1)}
    # What was sent at 0.2 s arrives at 0.4 s, before what was sent at 0.1 s, which is of no use at 1.0 s any more.
    assert at == {0.05: [], 0.1: [0.0], 0.35: [0.0], 0.4: [0.2], 1.1: [0.2]}


def test_noise_is_a_receivers_bad_luck_only_as_far_as_it_is_set(junction: Junction) -> None:
    radio = Radio(junction, channel_settings(noise=0.5, speed_noise=0.2))
    world = radio.world(0.0, CAV1, CAV2)
    true = next(v for v in world.vehicles if v.id == "CAV2")
    wrong = []
    for tick in range(200):
        radio.send(tick / 10, CAV1, CAV2)
        message = packets(radio, tick / 10)[0].messages[0]
        assert isinstance(message, CooperativeAwareness)
        told = message.state
        wrong.append((told.x - true.x, told.y - true.y, told.speed - true.speed))
        # All else is exact.
        assert (told.heading, told.lane, told.kind) == (true.heading, true.lane, true.kind)
    assert max(abs(x) for x, _, _ in wrong) <= 1.5
    assert 0.9 < max(abs(y) for _, y, _ in wrong) <= 1.5
    assert 0.3 < max(abs(v) for *_, v in wrong) <= 0.6


def test_no_speed_is_told_that_is_below_zero(junction: Junction) -> None:
    radio = Radio(junction, channel_settings(speed_noise=3.0))
    told = []
    for tick in range(50):
        radio.send(tick / 10, CAV1, car("CAV2", "south-north", 170.0, 0.0))
        message = packets(radio, tick / 10)[0].messages[0]
        assert isinstance(message, CooperativeAwareness)
        told.append(message.state.speed)
    assert min(told) == 0.0
    assert max(told) > 1.0


@given(st.lists(st.sampled_from([CAV2, car("CAV3", "east-west", 20.0, 5.0), HDV1]), unique=True))
def test_what_others_send_does_not_change_what_a_link_loses(junction: Junction, others: list[Car]) -> None:
    settings = channel_settings(loss=0.5, burst=2.0, age=0.3, age_shape=2.0)
    alone, among = Radio(junction, settings), Radio(junction, settings)
    for tick in range(12):
        alone.send(tick / 10, CAV1, CAV2)
        among.send(tick / 10, *{c.id: c for c in (CAV1, CAV2, *others)}.values())
        heard = [[p.time for p in packets(r, tick / 10) if p.sender == "CAV2"] for r in (alone, among)]
        assert heard[0] == heard[1]
