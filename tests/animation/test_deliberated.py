"""What is read from a line of decisions.jsonl; what another method wrote instead is left alone."""

from typing import Any

import pytest
from crossing import crossing, line, swapped
from hypothesis import given
from hypothesis import strategies as st

from codriving.animation.deliberated import deliberated
from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Severity

ROADS = crossing()
KEYS = ("time", "cavs", "id", "action", "reason", "scene", "intent", "route", "conflicts", "order", "sequence")
FURTHER = ("precedences", "first", "second", "ego", "other", "severity", "dttcp", "routes", "zone", "relation")
leaves = (
    st.none() | st.booleans() | st.integers(-3, 99) | st.floats(allow_nan=False) | st.sampled_from(["CAV1", "east"])
)
things = st.recursive(
    leaves,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from((*KEYS, *FURTHER)), inner, max_size=6),
    max_leaves=12,
)


def test_a_line_of_ours_is_read_in_full() -> None:
    read = deliberated(line(1.5), ROADS)
    assert read.time == 1.5
    assert read.thoughts["CAV2"].action is Action.SLOWER
    assert read.thoughts["CAV2"].reason == "lets it pass"
    assert read.thoughts["CAV2"].waits_for == ("HDV1",)
    assert read.thoughts["CAV1"].waits_for == ()
    assert read.routes == {"CAV1": "east", "CAV2": "east"}
    assert read.order == ("HDV1", "CAV1", "CAV2")
    (meeting,) = read.meetings
    assert (meeting.one, meeting.other, meeting.severity, meeting.certain) == ("CAV2", "HDV1", Severity.SERIOUS, False)
    assert meeting.ways == (("east", pytest.approx(30.0, abs=0.5)), ("south", pytest.approx(30.0, abs=0.5)))


def test_of_a_pair_the_worst_is_kept() -> None:
    entry = line(0.0)
    slight = swapped(entry["cavs"][1]["conflicts"][0], ego="HDV1", other="CAV2", dttcp=6.0, severity="slight danger")
    entry["cavs"][0]["conflicts"] = [slight]
    (meeting,) = deliberated(entry, ROADS).meetings
    assert meeting.dttcp == 1.2


def test_orders_of_their_own_are_no_common_order() -> None:
    entry = line(0.0)
    entry["cavs"][1]["order"] = swapped(entry["cavs"][1]["order"], sequence=["CAV2", "HDV1"])
    read = deliberated(entry, ROADS)
    assert read.order is None
    assert "own" in read.order_title


def test_an_order_that_binds_says_so() -> None:
    entry = line(0.0)
    for cav in entry["cavs"]:
        cav["order"] = swapped(cav["order"], binding=True)
    assert "binding" in deliberated(entry, ROADS).order_title


@pytest.mark.parametrize("changes", [{"zone": 7}, {"routes": ["east", "nowhere"]}, {"relation": "following"}])
def test_a_conflict_without_a_place_on_the_map_is_still_one(changes: dict[str, Any]) -> None:
    (meeting,) = deliberated(line(0.0, **changes), ROADS).meetings
    assert meeting.ways is None


@pytest.mark.parametrize(
    "entry", [{}, {"cavs": None}, {"cavs": [{"id": "CAV1"}]}, {"cavs": [7]}, {"time": 3.0, "x": 1}]
)
def test_a_line_of_another_method_is_no_error(entry: dict[str, Any]) -> None:
    assert deliberated(entry, ROADS).meetings == ()


@given(st.dictionaries(st.sampled_from((*KEYS, *FURTHER)), things, max_size=6))
def test_whatever_stands_there_is_no_error(entry: dict[str, Any]) -> None:
    deliberated(entry, ROADS)


@given(things, st.sampled_from(sorted(line(0.0)["cavs"][1]["conflicts"][0])))
def test_a_broken_conflict_is_no_error(value: object, key: str) -> None:
    deliberated(line(0.0, **{key: value}), ROADS)
