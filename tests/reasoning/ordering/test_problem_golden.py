"""The ordering problem of a scene, the coordinator's order and each CAV's own: the tables in ``golden/``."""

from collections.abc import Callable
from pathlib import Path

import pytest
from golden import Section, orders, posed, sections, setting
from worlds import Junction, Thoughts

from codriving.reasoning.ordering.negotiation import OwnOrders
from codriving.reasoning.ordering.problem import pose
from codriving.reasoning.sharing.sharing import OwnOrder


def problem(thoughts: Thoughts) -> str:
    return posed(pose(thoughts.moment()))


def coordinator(thoughts: Thoughts) -> str:
    return orders(thoughts.negotiate())


def own(reading: OwnOrder) -> Callable[[Thoughts], str]:
    def make_up(thoughts: Thoughts) -> str:
        found = OwnOrders(reading, 0).orders(thoughts.moment())
        return "; ".join(f"{ego}: {orders(order)}" for ego, order in sorted(found.items()))

    return make_up


MADE: dict[str, Callable[[Thoughts], str]] = {
    "problem": problem,
    "coordinator": coordinator,
    "own_view": own("own_view"),
    "same_rule": own("same_rule"),
}
TABLES = [(name, section) for name in MADE for section in sections(Path(__file__).parent / "golden" / f"{name}.md")]


@pytest.mark.parametrize(("table", "section"), TABLES, ids=[f"{name}: {s.title}" for name, s in TABLES])
def test_what_is_ordered_is_what_the_table_says(table: str, section: Section, road: Callable[[str], Junction]) -> None:
    junction = road(section.road)
    found = {value: MADE[table](setting(section.scene, value).think(junction)) for value, _ in section.rows}
    assert found == dict(section.rows)
