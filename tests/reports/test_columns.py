"""CSV with stable bytes."""

from random import Random

from hypothesis import given
from hypothesis import strategies as st

from codriving.reports.columns import Column, Table, mean


def test_numbers_have_six_significant_digits_and_no_negative_zero() -> None:
    values = {"a": 1 / 3, "b": 12345678.9, "c": -0.0, "d": 5, "e": None, "f": 'say "hi", twice'}
    columns = tuple(Column[object](key, lambda _: None) for key in values)
    assert Table(columns, (values,)).csv() == 'a,b,c,d,e,f\n0.333333,1.23457e+07,0,5,,"say ""hi"", twice"\n'


@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=20), st.randoms())
def test_a_mean_does_not_depend_on_order(values: list[float], random: Random) -> None:
    shuffled = list(values)
    random.shuffle(shuffled)
    assert mean(shuffled) == mean(values)


def test_of_nothing_there_is_no_mean() -> None:
    assert mean([]) is None
