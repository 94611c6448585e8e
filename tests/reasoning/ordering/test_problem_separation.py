"""What must lie between two vehicles in a zone."""

from worlds import Junction

from codriving.reasoning.ordering.problem import lag_length


def test_lag_length_is_enough_room_anywhere_in_the_zone(junction: Junction) -> None:
    for zone in junction.road_map.zones("south-north", "west-north"):
        needed = lag_length(zone)
        for k in range(60):
            s = zone.entry_j + k * (zone.exit_j - zone.entry_j) / 60
            assert float(zone.front(s)) <= s + needed + 0.5


def test_lag_length_of_either_vehicle_is_that_of_the_mirrored_zone(junction: Junction) -> None:
    for zone in junction.road_map.zones("south-north", "west-north"):
        assert lag_length(zone, False) == lag_length(zone.mirrored())
