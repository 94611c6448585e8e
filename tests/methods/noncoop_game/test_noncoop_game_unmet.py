"""The vehicle that was expected to brake and does not is not expected to any more, until it does."""

from seeing import game, seen_each
from worlds import Junction, car

from codriving.methods.noncoop_game.noncoop_game import UnmetExpectations


def test_a_vehicle_does_not_yield_if_it_was_to_brake_and_until_it_does() -> None:
    seen = UnmetExpectations()
    assert not seen.does_not_yield("CAV1", "HDV1", 8.0), "nothing was expected of it"
    seen.expected_to_brake("CAV1", "HDV1", 8.0)
    assert seen.does_not_yield("CAV1", "HDV1", 8.0)
    assert seen.does_not_yield("CAV1", "HDV1", 7.6)
    assert not seen.does_not_yield("CAV2", "HDV1", 8.0), "others have seen nothing yet"
    assert not seen.does_not_yield("CAV1", "HDV1", 7.4)
    assert not seen.does_not_yield("CAV1", "HDV1", 8.0), "it has been seen to brake"


def wishes(junction: Junction, slowing: float) -> list[str]:
    """What the game wishes next to a human driver from the left, who becomes slower at each decision, or does not."""
    moments = [
        (
            car("CAV1", "south-north", 84.0 + 3.5 * k, 7.0),
            car("HDV1", "west-east", 84.0 + (3.5 - slowing / 4) * k, 7.0 - slowing * k),
        )
        for k in range(3)
    ]
    driver = game()
    return [driver.decide(*view).reason.partition("; it wishes ")[2] for view in seen_each(junction, moments)]


def test_the_game_brakes_for_a_vehicle_that_does_not_and_goes_on_before_a_vehicle_that_does(junction: Junction) -> None:
    assert [wish[0] for wish in wishes(junction, 0.0)] == ["+", "-", "-"]
    assert [wish[0] for wish in wishes(junction, 1.0)] == ["+", "+", "+"]
