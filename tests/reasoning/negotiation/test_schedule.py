"""Times at which vehicles could pass, one after another."""

from worlds import Junction

from codriving.reasoning.negotiation.schedule import Slot, lag_length, start_time


def slot(name: str, eta: float, *windows: tuple[float, float]) -> Slot:
    return Slot(name, 100.0, eta, committed=False, turning=False, windows=list(windows))


def test_alone_a_vehicle_passes_when_it_can_be_there() -> None:
    assert start_time(slot("b", 3.0), {}, {}) == 3.0
    assert start_time(slot("b", 3.0), {"a": 2.0}, {}) == 3.0


def test_a_vehicle_waits_until_those_before_it_have_left() -> None:
    assert start_time(slot("b", 3.0), {"a": 2.0, "c": 4.0}, {("a", "b"): 2.5, ("b", "c"): 9.0}) == 4.5


def test_a_vehicle_passes_between_windows_but_not_inside_one() -> None:
    windows = (1.0, 4.0), (3.5, 6.0), (7.0, 8.0)
    assert start_time(slot("b", 3.0, *windows), {}, {}) == 6.0
    assert start_time(slot("b", 0.5, *windows), {}, {}) == 0.5
    assert start_time(slot("b", 7.5, *windows[::-1]), {}, {}) == 8.0


def test_lag_length_is_enough_room_anywhere_in_the_zone(junction: Junction) -> None:
    for zone in junction.road_map.zones("south-north", "west-north"):
        needed = lag_length(zone)
        for k in range(60):
            s = zone.entry_j + k * (zone.exit_j - zone.entry_j) / 60
            assert float(zone.front(s)) <= s + needed + 0.5
