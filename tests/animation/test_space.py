"""Words beside things cover neither the things nor one another, as long as there is room."""

from hypothesis import given
from hypothesis import strategies as st

from codriving.animation.space import Space, beside, overlap
from codriving.animation.window import Area

FRAME = Area(0.0, 0.0, 400.0, 300.0)


@given(st.lists(st.tuples(st.floats(0, 380), st.floats(0, 290)), max_size=12), st.floats(10, 90))
def test_words_stay_in_the_frame(places: list[tuple[float, float]], width: float) -> None:
    space = Space(FRAME)
    for x, y in places:
        own = Area(x, y, 20.0, 8.0)
        space.take(own)
        spot = space.find(beside(own, width, 15.0))
        assert spot.left >= 0
        assert spot.top >= 0
        assert spot.left + spot.width <= 400
        assert spot.top + spot.height <= 300


def test_three_side_by_side_cover_nothing() -> None:
    space = Space(FRAME)
    things = [Area(180.0, 100.0 + 20 * k, 30.0, 12.0) for k in range(3)]
    for thing in things:
        space.take(thing)
    spots = [space.find(beside(thing, 60.0, 15.0)) for thing in things]
    everything = [*things, *spots]
    assert all(overlap(a, b) == 0 for k, a in enumerate(everything) for b in everything[k + 1 :])


def test_what_stands_upright_is_named_at_its_side() -> None:
    own = Area(100.0, 100.0, 8.0, 20.0)
    spot = Space(FRAME).find(beside(own, 60.0, 15.0))
    assert spot.left >= own.left + own.width
