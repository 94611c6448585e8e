"""The order that is shown beside a game of actions."""

from coalitions import Scheduled, entrant, instance

from codriving.datatypes.action import Action
from codriving.methods.coop_game_fuzzy.arrival import Arrival
from codriving.reasoning.ordering.request import Request


def test_whoever_came_first_is_shown_first() -> None:
    problem = instance(entrant("a", 4), entrant("b", 2), conflicts=[("a", "b")])
    rule = Arrival(60.0)
    rule.reset(0)
    assert (rule.name, rule.variant) == ("coop_game", "")
    assert rule.order(problem, Scheduled(problem)).sequence == ("b", "a")


def test_lane_changes_that_gain_most_together_are_granted() -> None:
    requests = [
        Request("a", Action.LANE_LEFT, 1.0, 0.0, frozenset("b")),
        Request("b", Action.LANE_LEFT, 2.0, 1.0, frozenset("a")),
    ]
    assert Arrival(60.0).grant(requests) == {"b"}
