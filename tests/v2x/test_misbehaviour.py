"""Each kind of misbehaviour changes what an honest CAV decides; who misbehaves is drawn and noted, and never told."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from itertools import product

import pytest
from hearing import Radio
from worlds import Car, Junction, car

from codriving.config.compose import compose
from codriving.datatypes.parts import RuleModel
from codriving.datatypes.record import Collision, Ending, Outcome
from codriving.datatypes.world import Kind, VehicleState, WorldState
from codriving.environment.environment import Environment
from codriving.experiment.episode import Labels, run_episode
from codriving.experiment.objects import make_method
from codriving.v2x.channel import Packet
from codriving.v2x.connected import Connected, ConnectedDeliberation
from codriving.v2x.messages import CollectivePerception, CooperativeAwareness, ManoeuvreCoordination
from codriving.v2x.misbehaviour import Misconduct
from codriving.v2x.settings import Misbehaviour

KINDS = ("lies_position", "lies_intent", "ghost", "does_not_yield", "never_answers")

CLEAR = ("v2x=good", "v2x.loss=0", "v2x.noise=0", "v2x.speed_noise=0", "v2x.coordination.by=none")


def shares(**change: float) -> Misbehaviour:
    """Nothing misbehaves but what is named."""
    return Misbehaviour(**{**dict.fromkeys(KINDS, 0.0), "along": 15.0, "across": 3.5, **change})


def connected(*overrides: str) -> Connected:
    """The method of a config, with its channel."""
    method = make_method(compose([*CLEAR, *overrides]), RuleModel(), None)
    assert isinstance(method, Connected)
    return method


def decided(
    junction: Junction, cars: Iterable[Car], kinds: Mapping[str, str], *overrides: str, seed: int = 0
) -> ConnectedDeliberation:
    """What is decided a second after cars came, at their speed, to where they are now."""
    method = connected(*overrides)
    method.reset(junction.road_map, junction.model, seed)
    method._misconduct._kinds = {one.id: kinds.get(one.id, "") for one in cars}
    assert method.observer is not None
    for tick in range(11):
        before = [replace(c, place=c.place - (1 - tick / 10) * c.speed) for c in cars]
        world = junction.world(*before, time=tick / 10)
        method.observer(world)
    return method.act(world)


def actions(
    junction: Junction, cars: list[Car], liar: str, seed: int = 0, who: str = "CAV1"
) -> tuple[tuple[str, str, str], float]:
    """What one CAV does: where all are honest; where one is not; and there if it looks whether messages are plausible.

    And how many messages are then not believed.
    """
    found = [
        decided(junction, cars, kinds, *overrides, seed=seed)
        for kinds, overrides in (({}, ()), ({"CAV2": liar}, ()), ({"CAV2": liar}, ("v2x.plausibility=true",)))
    ]
    honest, misled, looking = (str(one.actions[who]) for one in found)
    assert "messages_rejected" not in found[1].counts
    assert found[2].counts["messages_rejected_honest"] == 0
    return (honest, misled, looking), found[2].counts["messages_rejected"]


# Sensors that see 30 m see that there is no vehicle where it is said to be; those that see 10 m do not.
@pytest.mark.parametrize(("reach", "misled", "rejected"), [(30, "FASTER", 3), (10, "SLOWER", 0)])
def test_a_false_position_delays_who_cannot_see_that_there_is_no_vehicle_where_it_is_said_to_be(
    reach: int, misled: str, rejected: int, configured: Callable[..., Environment]
) -> None:
    near = Junction(configured("scenario=intersection", f"scenario.detection_range={reach}"))
    cars = [car("CAV1", "south-north", 86.0, 7.0, 9.0), car("CAV2", "west-east", 78.0, 7.0, 9.0)]
    assert actions(near, cars, "lies_position", seed=2) == (("FASTER", misled, misled), rejected)


def test_a_false_route_lets_go_first_who_does_not_see_that_the_turn_has_begun(junction: Junction) -> None:
    cars = [car("CAV1", "north-south", 91.0, 7.0, 9.0), car("CAV2", "south-west", 106.0, 5.0, 5.0)]
    assert actions(junction, cars, "lies_intent") == (("SLOWER", "FASTER", "SLOWER"), 3)


# In the name of a sender that is not there (1 message), or among what the liar says that it sees (3).
@pytest.mark.parametrize(("seed", "messages"), [(0, 3), (1, 1)])
@pytest.mark.parametrize(("reach", "misled"), [(50, "FASTER"), (15, "SLOWER")])
def test_a_ghost_is_braked_for_unless_sensors_see_that_the_way_is_free(
    seed: int, messages: int, reach: int, misled: str, configured: Callable[..., Environment]
) -> None:
    there = Junction(configured("scenario=intersection", f"scenario.detection_range={reach}"))
    cars = [car("CAV1", "north-south", 88.0, 7.0, 9.0), car("CAV2", "south-west", 60.0, 5.0, 6.0)]
    found = messages if misled == "FASTER" else 0
    assert actions(there, cars, "ghost", seed) == (("FASTER", misled, misled), found)


def test_who_does_not_yield_drives_where_it_agreed_to_wait(junction: Junction) -> None:
    cars = [car("CAV1", "south-north", 86.0, 7.0, 9.0), car("CAV2", "west-east", 84.0, 7.0, 9.0)]
    assert actions(junction, cars, "does_not_yield", who="CAV2") == (("SLOWER", "FASTER", "FASTER"), 0)
    # What the others do at that time is as if it waited.
    assert actions(junction, cars, "does_not_yield")[0] == ("FASTER", "FASTER", "FASTER")


def test_who_never_answers_is_taken_for_a_human_driver(junction: Junction) -> None:
    cars = [car("CAV1", "south-north", 90.0, 7.0, 9.0), car("CAV2", "west-east", 84.0, 7.0, 9.0)]
    assert actions(junction, cars, "never_answers") == (("FASTER", "SLOWER", "SLOWER"), 0)


def misconduct(junction: Junction, settings: Misbehaviour, seed: int = 0) -> Misconduct:
    """What the CAVs of an episode do."""
    return Misconduct(settings, junction.road_map, junction.model, seed)


def test_each_cav_is_drawn_by_itself_and_stays_what_it_is_at_a_higher_share(junction: Junction) -> None:
    names = [f"CAV{k}" for k in range(1, 5)]
    few: dict[tuple[int, str], str] = {}
    many: dict[tuple[int, str], str] = {}
    for seed in range(300):
        low, high = (misconduct(junction, shares(ghost=share), seed) for share in (0.1, 0.25))
        few |= {(seed, name): low.kind_of(name) for name in names}
        many |= {(seed, name): high.kind_of(name) for name in reversed(names)}
    assert set(few.values()) == {"", "ghost"}
    assert all(many[one] == "ghost" for one, kind in few.items() if kind)
    # 1,200 draws: four standard deviations are 3.5 and 5 %.
    assert sum(map(bool, few.values())) / 1200 == pytest.approx(0.1, abs=0.035)
    assert sum(map(bool, many.values())) / 1200 == pytest.approx(0.25, abs=0.05)


def test_kinds_share_the_cavs_among_them(junction: Junction) -> None:
    settings = shares(**dict.fromkeys(KINDS, 0.2))
    drawn = [misconduct(junction, settings, seed).kind_of("CAV1") for seed in range(500)]
    assert {kind: drawn.count(kind) for kind in KINDS} == pytest.approx(dict.fromkeys(KINDS, 100), abs=36)
    assert "" not in drawn


CARS = (
    car("CAV1", "south-north", 50.0, 8.0, 9.0),
    car("CAV2", "west-east", 70.0, 6.0, 9.0),
    car("HDV1", "west-east", 85.0, 4.0),
)


def packet(junction: Junction, kind: str, seed: int = 3) -> tuple[Packet, WorldState, Radio]:
    """What CAV2 sends in one tick, and in which world."""
    radio = Radio(junction, seed=seed)
    radio.misconduct._kinds = {"CAV1": "", "CAV2": kind}
    world = radio.send(0.0, *CARS)
    return next(p for p in radio.channel.received("CAV1", 0.0) if p.sender == "CAV2"), world, radio


def test_a_false_position_is_so_far_along_and_so_far_across_and_all_else_is_true(junction: Junction) -> None:
    honest, _, _ = packet(junction, "")
    sides = set()
    for seed in range(12):
        found, _, _ = packet(junction, "lies_position", seed)
        state = found.messages[0]
        assert isinstance(state, CooperativeAwareness)
        place, offset = junction.road_map.project("west-east", state.state.x, state.state.y)
        sides.add((round(place - 70.0, 6), round(offset, 6)))
        assert (state.state.speed, state.state.id) == (6.0, "CAV2")
        assert found.messages[1:] == honest.messages[1:]
    assert sides == set(product((15.0, -15.0), (3.5, -3.5)))


def test_a_false_intent_is_one_that_the_map_allows_from_the_same_lane(junction: Junction) -> None:
    honest, _, _ = packet(junction, "")
    told = set()
    for seed in range(20):
        found, _, _ = packet(junction, "lies_intent", seed)
        intent = found.messages[2]
        assert isinstance(intent, ManoeuvreCoordination)
        assert found.messages[:2] == honest.messages[:2]
        assert intent.intent.route in {"west-north", "west-south"}
        assert intent.intent.target_speed in {0.0, 3.0, 6.0}
        told.add((intent.intent.route, intent.intent.target_speed))
    assert len(told) == 6


def test_who_never_answers_tells_its_state_and_what_it_sees(junction: Junction) -> None:
    honest, _, _ = packet(junction, "")
    found, _, radio = packet(junction, "never_answers")
    assert found.messages == honest.messages[:2]
    assert radio.channel.messages == 5


def test_a_ghost_drives_ahead_of_another_cav_and_is_told_of_in_one_of_two_ways(junction: Junction) -> None:
    honest, _, _ = packet(junction, "")
    ways = set()
    for seed in range(8):
        found, world, radio = packet(junction, "ghost", seed)
        own = radio.channel.received("CAV1", 0.0)
        if len(own) == 2:
            (state,) = next(p for p in own if p.sender != "CAV2").messages
            assert isinstance(state, CooperativeAwareness)
            ghost = state.state
            assert found.messages == honest.messages
        else:
            objects = found.messages[1]
            assert isinstance(objects, CollectivePerception)
            seen, invented = objects.objects
            assert (seen.state.id, objects.size) == ("HDV1", 240 + 2 * 35)
            ghost = invented.state
        ways.add((ghost.id, ghost.kind))
        place, offset = junction.road_map.project("south-north", ghost.x, ghost.y)
        assert (place, offset, ghost.speed) == (pytest.approx(75.0), pytest.approx(0.0, abs=1e-9), 4.5)
        assert ghost.id not in {v.id for v in world.vehicles}
    assert ways == {("CAV90000", Kind.CAV), ("HDV90000", Kind.HDV)}


def test_a_ghost_goes_on_for_8_s_and_is_another_one_then(junction: Junction) -> None:
    ghosts: dict[str, list[VehicleState]] = {}
    found = misconduct(junction, shares(ghost=1.0))
    found._kinds = {"CAV1": "", "CAV2": "ghost"}
    for tick in range(100):
        for inventor, ghost, _ in found.ghosts(junction.world(*CARS, time=tick / 10)):
            assert inventor.id == "CAV2"
            ghosts.setdefault(ghost.id[3:], []).append(ghost)
    assert {name: len(each) for name, each in ghosts.items()} == {"90000": 80, "90001": 20}
    way = [junction.road_map.project("south-north", g.x, g.y)[0] for g in ghosts["90000"]]
    assert (way[0], way[-1]) == (pytest.approx(75.0), pytest.approx(75.0 + 7.9 * 4.5))


def test_where_all_are_honest_messages_are_those_that_they_were_and_no_more_is_counted(junction: Junction) -> None:
    found, world = misconduct(junction, shares()), junction.world(*CARS)
    messages = packet(junction, "")[0].messages
    assert found.sent(world.cavs[1], messages, world) is messages
    assert list(found.ghosts(world)) == []
    counts = decided(junction, list(CARS), {}).counts
    assert not [name for name in counts if "rejected" in name or "misbehav" in name]


def test_who_does_not_yield_minds_human_drivers_and_those_on_its_way_or_beside_it(junction: Junction) -> None:
    radio = Radio(junction, ego="CAV2")
    others = {
        "CAV1": car("CAV1", "south-north", 90.0, 8.0),
        "CAV3": car("CAV3", "west-north", 90.0, 5.0),
        "CAV4": car("CAV4", "west-east", 60.0, 5.0, offset=4.0),
        "CAV5": car("CAV5", "north-south", 112.0, 5.0),
        "HDV1": car("HDV1", "east-west", 80.0, 5.0),
    }
    radio.send(0.0, CARS[1], *others.values())
    known = radio.look(0.0, CARS[1], *others.values())
    assert {v.id for v in known.vehicles} == {"CAV2", *others}
    kept = radio.misconduct.pushing(known)
    assert {v.id for v in kept.vehicles} == {"CAV2", "CAV3", "CAV4", "CAV5", "HDV1"}
    assert set(kept.intents) == set(kept.available) == {"CAV2", "CAV3", "CAV4", "CAV5"}


def test_who_misbehaves_stands_in_the_record_and_collisions_are_told_apart(
    configured: Callable[..., Environment],
) -> None:
    environment = configured("scenario=intersection", "scenario.cavs=2", "scenario.hdvs=[1,1]", "scenario.time_limit=3")
    method = connected("method=fcfs", "v2x.misbehaviour.never_answers=1")
    record = run_episode(environment, method, {}, 10_000, Labels("intersection", "fcfs", "", "none")).record
    kinds = {p.id: p.style for p in record.participants}
    assert {name: kind for name, kind in kinds.items() if name.startswith("CAV")} == {
        "CAV1": "never_answers",
        "CAV2": "never_answers",
    }
    assert "never_answers" not in {kind for name, kind in kinds.items() if name.startswith("HDV")}
    assert record.counts["misbehaving"] == 2
    method._misbehaving = {"CAV2": "ghost"}
    told = []
    for pair in (("CAV1", "HDV1"), ("CAV1", "CAV2"), ("HDV1", "CAV2")):
        outcome = Outcome(Ending.COLLISION, 3.0, {}, Collision(3.0, *pair, "CAV-CAV"))
        counts, _ = method.conclude(environment.reset(10_000), outcome)
        told.append((counts["collisions_of_honest"], counts["collisions_with_misbehaving"]))
    assert told == [(1, 0), (0, 1), (0, 1)]


def test_no_method_sees_who_misbehaves(junction: Junction, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[WorldState] = []
    method = connected("method=fcfs", "v2x.misbehaviour.ghost=1", "v2x.plausibility=true")
    method.reset(junction.road_map, junction.model, 1)
    monkeypatch.setattr(type(method.method), "act", lambda _, world: _break_off(seen, world))
    with pytest.raises(ZeroDivisionError):
        method.act(junction.world(*CARS))
    assert method.misbehaving == {"CAV1": "ghost"}
    assert not [kind for kind in KINDS if kind in repr(seen)]
    assert "misbehav" not in repr(seen)


def _break_off(seen: list[WorldState], world: WorldState) -> None:
    seen.append(world)
    raise ZeroDivisionError


@pytest.mark.parametrize("world", [("scenario=intersection",), ("scenario=merge",)])
def test_no_honest_message_is_rejected_for_noise(
    world: tuple[str, ...], configured: Callable[..., Environment]
) -> None:
    environment = configured(*world, "scenario.cavs=3", "scenario.hdvs=[2,2]", "scenario.time_limit=12")
    method = make_method(compose(["v2x=good", "method=fcfs", "v2x.plausibility=true", *world]), RuleModel(), None)
    record = run_episode(environment, method, {}, 10_003, Labels("", "fcfs", "", "none")).record
    assert record.counts["messages_rejected"] == 0
    assert record.counts["messages"] > 500


@pytest.mark.parametrize("method", ["codriving", "fcfs"])
def test_who_does_not_yield_accepts_what_is_proposed_and_who_never_answers_says_nothing(
    method: str, junction: Junction
) -> None:
    cars = [car("CAV1", "south-north", 86.0, 7.0, 9.0), car("CAV2", "west-east", 84.0, 7.0, 9.0)]
    answers: dict[str, dict[tuple[str, str], int]] = {}
    driven: dict[str, tuple[str, ...]] = {}
    for kind in ("", "does_not_yield", "never_answers"):
        made = connected(f"method={method}", "v2x.coordination.by=road_side_unit")
        made.reset(junction.road_map, junction.model, 0)
        made._misconduct._kinds = {"CAV1": "", "CAV2": kind}
        found: dict[tuple[str, str], int] = {}
        for tick in range(21):
            before = [replace(c, place=c.place - (2 - tick / 10) * c.speed) for c in cars]
            world = junction.world(*before, time=tick / 10)
            made._hear(world)
            if tick % 10 == 0:
                line = made.act(world)
                for message in line.as_dict().get("said", ()):
                    key = (message["sender"], message["kind"])
                    found[key] = found.get(key, 0) + 1
        answers[kind], driven[kind] = found, tuple(str(a) for _, a in sorted(line.actions.items()))
    assert answers["does_not_yield"].get(("CAV2", "acceptance"), 0) > 0
    assert answers["does_not_yield"].get(("RSU", "agreement"), 0) > 0
    assert not [sender for sender, _ in answers["never_answers"] if sender == "CAV2"]
    assert driven["does_not_yield"][1] == "FASTER"
    assert driven[""][1] != "FASTER"


@pytest.mark.parametrize("by", ["road_side_unit", "fleet"])
def test_the_unit_that_coordinates_answers_whatever_the_share_of_cavs_that_do_not(junction: Junction, by: str) -> None:
    made = connected("v2x.misbehaviour.never_answers=1", f"v2x.coordination.by={by}")
    made.reset(junction.road_map, junction.model, 0)
    made._misconduct._kinds = {"CAV1": "", "CAV2": ""}
    cars = [car("CAV1", "south-north", 40.0, 8.0), car("CAV2", "west-east", 42.0, 8.0)]
    kinds: set[str] = set()
    for tick in range(16):
        world = junction.world(*[replace(c, place=c.place + tick / 10 * c.speed) for c in cars], time=tick / 10)
        made._hear(world)
        if tick % 5 == 0:
            kinds |= {message["kind"] for message in made.act(world).as_dict()["said"]}
    assert kinds == {"proposal", "acceptance", "agreement"}
