"""The paper's four bands, and times to the conflict point."""

import math

import pytest

from codriving.datatypes.order import Severity
from codriving.reasoning.conflicts import severity, ttcp


@pytest.mark.parametrize(
    ("dttcp", "band"),
    [
        (0.0, Severity.SERIOUS),
        (2.0, Severity.SERIOUS),
        (2.001, Severity.GENERAL),
        (5.0, Severity.GENERAL),
        (5.001, Severity.SLIGHT),
        (7.999, Severity.SLIGHT),
        (8.001, Severity.NONE),
        (100.0, Severity.NONE),
    ],
)
def test_bands_are_those_of_the_paper(dttcp: float, band: Severity) -> None:
    assert severity(dttcp) is band


def test_time_is_distance_over_speed() -> None:
    assert ttcp(30.0, 6.0) == pytest.approx(5.0)


def test_who_is_at_the_point_needs_no_time() -> None:
    assert ttcp(0.0, 0.0) == ttcp(-4.0, 7.0) == 0


def test_who_stands_needs_long_but_not_for_ever() -> None:
    assert ttcp(10.0, 6.0) < ttcp(10.0, 0.0) < math.inf
