"""One look-up in the table says the same as the two neighbouring rows, and both limits together the same as each."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from codriving.geometry.zone import Band, FollowingBand

BULGE = 0.1
numbers = st.floats(-50.0, 50.0)


@st.composite
def bands(draw: st.DrawFn) -> Band:
    """Bands of a few rows, limits in any order."""
    n = draw(st.integers(1, 9))
    low, high = (draw(arrays(np.float64, n, elements=numbers)) for _ in range(2))
    return Band(draw(numbers), draw(st.sampled_from([0.5, 0.4973, 0.51])), low, high)


def by_rows(band: Band, s: float) -> tuple[float, float]:
    """The worse of the row before and the row after, as the class promises it."""
    low = np.concatenate(([np.inf], band.low, [np.inf]))
    high = np.concatenate(([-np.inf], band.high, [-np.inf]))
    row = min(max((s - band.start) / band.spacing, -1.0), float(len(band.low)))
    k = [int(np.floor(row)) + 1, int(np.ceil(row)) + 1]
    return float(low[k].min() - BULGE), float(high[k].max() + BULGE)


@given(bands(), st.lists(st.floats(-3.0, 13.0), min_size=1, max_size=6))
def test_a_look_up_is_the_worse_of_both_rows(band: Band, rows: list[float]) -> None:
    places = [band.start + band.spacing * row for row in (*rows, *range(-2, len(band.low) + 2))]
    places += [float("inf"), float("-inf")]
    expected = [by_rows(band, s) for s in places]
    assert list(zip(band.lowest(places).tolist(), band.highest(places).tolist(), strict=True)) == expected


@given(bands() | st.builds(FollowingBand, st.floats(1.0, 9.0)), arrays(np.float64, (2, 3), elements=numbers))
def test_both_limits_in_one_go_are_those_one_by_one(band: Band | FollowingBand, places: np.ndarray) -> None:
    low, high = band.blocked(places)
    assert low.tobytes() == band.lowest(places).tobytes()
    assert high.tobytes() == band.highest(places).tobytes()
    assert low.shape == high.shape == places.shape
