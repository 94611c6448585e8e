"""Numbers that are printed per action: how they are read off a prompt, and that none hands over the rules' answer."""

from asked import reasoned, sensible
from shown import WORLDS
from worlds import Car, Junction

from benchmarks.prompt_numbers import Agreement, measure, numbers
from codriving.datatypes.situation import Situation
from codriving.datatypes.world import Action

TEXT = """4. Decision.
- SLOWER to 6.0 m/s: at the zone with CAV3 and CAV2 in 5.8 s, with HDV1 in 6.4 s, can stop; \
B behind has to brake with 1.2 m/s2; delays X by up to 1.9 s
- IDLE, FASTER to 9.0 m/s: at the zone with CAV3 in 4.1 s, with HDV1 never, cannot stop for HDV1
- LANE_LEFT removed: same lane: LANE_LEFT leaves 5.0 m
Allowed actions: SLOWER, IDLE, FASTER"""


def test_each_number_is_read_by_what_is_said_before_it() -> None:
    found = numbers(TEXT)
    assert found["to [m/s]"] == {Action.SLOWER: 6.0, Action.IDLE: 9.0, Action.FASTER: 9.0}
    assert found["zone of CAV3 [s]"] == {Action.SLOWER: 5.8, Action.IDLE: 4.1, Action.FASTER: 4.1}
    assert found["zone of CAV2 [s]"] == {Action.SLOWER: 5.8}
    assert found["zone of HDV1 [s]"] == {Action.SLOWER: 6.4}
    assert found["braking behind [m/s2]"] == {Action.SLOWER: 1.2}
    assert found["delay [s]"] == {Action.SLOWER: 1.9}
    assert len(found) == 6
    assert numbers("- SLOWER to 6.0 m/s: gets 49 m, arrives 4.2 s")["gets [m]"] == {Action.SLOWER: 49.0}


def test_the_better_end_of_a_number_counts() -> None:
    assert Agreement(10, (7, 2), 8).row() == {"printed": 10, "agrees": 0.7, "first": 0.8}


def moved(cars: tuple[Car, ...], metres: float) -> tuple[Car, ...]:
    """The same cars, the CAVs farther along."""
    return tuple(Car(c.id, c.route, c.place + metres * c.id.startswith("CAV"), c.speed, c.target) for c in cars)


def test_no_number_of_informed_names_the_rules_action_more_often_than_the_fastest_does(
    junction: Junction, roundabout: Junction, merge: Junction, highway: Junction
) -> None:
    seen: list[Situation] = []
    for name, world in {"intersection": junction, "roundabout": roundabout, "merge": merge, "highway": highway}.items():
        for metres in (-8.0, -4.0, 0.0, 4.0):
            made = reasoned(world, sensible, ask_plain=True)
            seen += made.method.act(world.world(*moved(WORLDS[name], metres))).situations
    rows = measure([s for s in seen if len(s.allowed) > 1], "informed")
    assert {"to [m/s]", "zone [s]"} <= rows.keys()
    assert not [name for name in rows if "[m]" in name]
    for name, row in rows.items():
        # Of few decisions any share may be.
        assert row["printed"] < 10 or row["agrees"] <= row["first"], f"{name} hands over what the rules do"
