"""The coordinator by a model: what it is asked, what becomes of what it says, and when it is asked again."""

import json
from collections.abc import Callable

import pytest
from asked import negotiating, orders, pairs, shown
from worlds import Car, Junction, Thoughts, car

from codriving.datatypes.order import PassingOrder
from codriving.errors import ModelUnavailableError
from codriving.llm.ledger import Ledger
from codriving.llm.prompts.render import load_prompts
from codriving.llm.question import Question
from codriving.llm.scripted import Script, ScriptedChat
from codriving.methods.language_model.model_coordinator import ModelCoordinator
from codriving.methods.language_model.prompted_model import PromptedModel
from codriving.reasoning.ordering.coordinator import RuleCoordinator

Coordinate = Callable[..., tuple[PassingOrder, ModelCoordinator, ScriptedChat, dict[str, float]]]

THREE = (
    car("CAV1", "south-north", 60, 8, 9),
    car("CAV2", "west-east", 62, 8, 9),
    car("CAV3", "east-south", 62, 8, 9),
)
"""Each vehicle crosses every other one's way, and none is committed."""


def coordinator(thoughts: Thoughts, script: Script) -> tuple[ModelCoordinator, ScriptedChat, Ledger]:
    chat, ledger = ScriptedChat(script), Ledger()
    return ModelCoordinator(PromptedModel(chat, load_prompts("planner"), ledger), False), chat, ledger


def again(made: ModelCoordinator, thoughts: Thoughts) -> PassingOrder:
    return made.negotiate(thoughts.moment())


def by_rule(thoughts: Thoughts) -> PassingOrder:
    return RuleCoordinator(False).negotiate(thoughts.moment())


def firsts(order: PassingOrder) -> dict[frozenset[str], str]:
    return {frozenset((p.first, p.second)): p.first for p in order.precedences}


def turned(question: Question) -> list[tuple[str, str]]:
    """The order that is named last to first: CAV3 before CAV2 before CAV1."""
    return [(name, max(pair)) for name, pair in pairs(question).items()]


def test_model_decides_the_pairs_and_gives_the_reasons(junction: Junction) -> None:
    thoughts = junction.thoughts(*THREE)
    made, chat, ledger = coordinator(thoughts, lambda q: orders(*turned(q)))
    order = again(made, thoughts)
    assert order.sequence == ("CAV3", "CAV2", "CAV1") != by_rule(thoughts).sequence
    assert {p.reason for p in order.precedences} == {"it can be there earlier"}
    counts, lines = ledger.close_step(0.0)
    assert chat.calls == counts["model_calls"] == 1
    assert not counts.get("repaired_orders")
    # Of three pairs, 25 each: a list of 24 pairs with short reasons takes 604 tokens, and 300 are there anyway.
    assert [q.more_tokens for q in chat.questions] == [75]
    assert [(line["purpose"], line["subject"]) for line in lines] == [("negotiate", "")]


def test_only_pairs_of_cavs_in_conflict_are_asked_about(junction: Junction) -> None:
    thoughts = junction.thoughts(*THREE[:2], car("CAV4", "south-east", 30, 8), car("HDV1", "west-east", 85, 5))
    made, chat, _ = coordinator(thoughts, lambda q: orders(*turned(q)))
    order = again(made, thoughts)
    assert set(map(frozenset, pairs(chat.questions[0]).values())) == {
        frozenset((c.ego, c.other)) for cs in thoughts.conflicts.values() for c in cs if "HDV1" not in (c.ego, c.other)
    }
    assert "HDV1" not in shown(chat.questions[0])
    assert any("HDV1" in (p.first, p.second) for p in order.precedences)


@pytest.mark.parametrize("cars", [(THREE[0],), (THREE[0], car("HDV1", "west-east", 60, 8)), ()], ids=len)
def test_nothing_is_asked_without_two_cavs_in_conflict(junction: Junction, cars: tuple[Car, ...]) -> None:
    thoughts = junction.thoughts(*cars)
    made, chat, _ = coordinator(thoughts, negotiating("must not be asked"))
    assert again(made, thoughts) == by_rule(thoughts)
    assert chat.calls == 0


def test_what_is_physically_fixed_is_not_asked_and_stays(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 97, 8, 9), *THREE[1:])
    made, chat, _ = coordinator(thoughts, lambda q: orders(*turned(q)))
    order = again(made, thoughts)
    assert [set(pair) for pair in pairs(chat.questions[0]).values()] == [{"CAV2", "CAV3"}]
    assert order.sequence == ("CAV1", "CAV3", "CAV2")


WRONG: dict[str, Callable[[Question], list[tuple[str, str]]]] = {
    "missing": lambda q: turned(q)[:-1],
    "unknown vehicle": lambda q: [*turned(q)[:-1], (turned(q)[-1][0], "CAV9")],
    "unknown pair": lambda q: [*turned(q)[:-1], ("p9", "CAV1")],
    "contradicts itself": lambda q: [*turned(q), (turned(q)[-1][0], min(pairs(q)[turned(q)[-1][0]]))],
}


@pytest.mark.parametrize("kind", WRONG)
def test_what_is_wrong_in_an_order_is_decided_by_rule_and_counted(junction: Junction, kind: str) -> None:
    thoughts = junction.thoughts(*THREE)
    made, chat, ledger = coordinator(thoughts, lambda q: orders(*WRONG[kind](q)))
    order = again(made, thoughts)
    kept = turned(chat.questions[0])[:-1]
    for name, first in kept:
        assert order.first_of(*pairs(chat.questions[0])[name]) == first
    assert len(order.precedences) == 3
    counts, _ = ledger.close_step(0.0)
    assert counts["repaired_orders"] == 1
    assert chat.calls == 1
    assert not counts["fallbacks"]


def test_least_severe_link_of_a_circle_is_dropped_and_counted(junction: Junction) -> None:
    thoughts = junction.thoughts(*THREE)
    wins = {frozenset(("CAV1", "CAV2")): "CAV1", frozenset(("CAV2", "CAV3")): "CAV2"}

    def circle(question: Question) -> str:
        return orders(*((name, wins.get(frozenset(pair), "CAV3")) for name, pair in pairs(question).items()))

    made, chat, ledger = coordinator(thoughts, circle)
    order = again(made, thoughts)
    asked = list(pairs(chat.questions[0]).values())
    dttcp = {frozenset((c.ego, c.other)): c.dttcp for cs in reversed(thoughts.conflicts.values()) for c in cs[::-1]}
    loosest = max((frozenset(pair) for pair in asked), key=dttcp.__getitem__)
    for pair, first in firsts(order).items():
        assert (first == wins.get(pair, "CAV3")) is (pair != loosest)
    assert ledger.close_step(0.0)[0]["repaired_orders"] == 1


@pytest.mark.parametrize("text", ["", "no idea", "{}", '{"orders": []}', '{"orders": [{"pair": "p9", "first": "x"}]}'])
def test_without_an_answer_the_rules_decide_and_it_is_counted(junction: Junction, text: str) -> None:
    thoughts = junction.thoughts(*THREE)
    made, chat, ledger = coordinator(thoughts, negotiating(text))
    assert again(made, thoughts) == by_rule(thoughts)
    counts, _ = ledger.close_step(0.0)
    assert (chat.calls, counts["fallbacks"], counts["re_asks"]) == (2, 1, 1)
    again(made, thoughts)
    assert chat.calls == 4, "nothing has been agreed on"


def test_second_try_counts(junction: Junction) -> None:
    thoughts = junction.thoughts(*THREE)
    answers = iter(["what?", ""])
    made, _, ledger = coordinator(thoughts, lambda q: next(answers) or orders(*turned(q)))
    assert again(made, thoughts).sequence == ("CAV3", "CAV2", "CAV1")
    counts, _ = ledger.close_step(0.0)
    assert (counts["re_asks"], counts["fallbacks"]) == (1, 0)


def test_unreachable_model_ends_the_episode(junction: Junction) -> None:
    thoughts = junction.thoughts(*THREE)

    def fails(question: Question) -> Exception:
        return ModelUnavailableError("no answer")

    with pytest.raises(ModelUnavailableError):
        again(coordinator(thoughts, fails)[0], thoughts)


def moved(*places: float) -> tuple[Car, ...]:
    return tuple(car(c.id, c.route, place, c.speed, c.target) for c, place in zip(THREE, places, strict=False))


def test_answer_is_kept_while_its_premise_holds(junction: Junction) -> None:
    first = junction.thoughts(*THREE)
    made, chat, ledger = coordinator(first, lambda q: orders(*turned(q)))
    agreed = again(made, first)
    kept = again(made, junction.thoughts(*moved(64, 66, 66)))
    assert (kept.sequence, firsts(kept)) == (agreed.sequence, firsts(agreed))
    assert {p.reason for p in kept.precedences} == {"it can be there earlier"}
    assert chat.calls == 1
    assert ledger.close_step(0.0)[0]["kept_orders"] == 1


@pytest.mark.parametrize(
    ("cars", "asked_again"),
    [
        (moved(64, 66), False),
        (moved(45, 66, 66), True),
        ((*moved(64, 66, 66), car("CAV4", "north-south", 40, 8)), True),
        ((*moved(64, 66, 66), car("HDV1", "west-east", 85, 5)), True),
        ((*moved(64, 66, 66), car("HDV1", "north-south", 5, 3)), False),
    ],
    ids=["one has left", "one fell behind", "a new CAV", "a human in the way", "a human out of sight"],
)
def test_answer_is_asked_for_again_when_its_premise_has_changed(
    junction: Junction, cars: tuple[Car, ...], asked_again: bool
) -> None:
    first = junction.thoughts(*THREE)
    made, chat, _ = coordinator(first, lambda q: orders(*((name, min(pair)) for name, pair in pairs(q).items())))
    again(made, first)
    again(made, junction.thoughts(*cars))
    assert chat.calls == 1 + asked_again


def test_agreement_that_has_become_impossible_is_asked_for_again(junction: Junction) -> None:
    first = junction.thoughts(*THREE)
    made, chat, _ = coordinator(first, lambda q: orders(*turned(q)))
    again(made, first)
    # CAV1 was to go last, and cannot stop any more.
    order = again(made, junction.thoughts(*moved(97, 66, 66)))
    assert chat.calls == 2
    assert order.sequence[0] == "CAV1"


def test_shorter_question_is_about_the_more_urgent_half(junction: Junction) -> None:
    thoughts = junction.thoughts(*THREE)
    made, chat, _ = coordinator(thoughts, lambda q: orders(*turned(q)))
    again(made, thoughts)
    full = chat.questions[0]
    half = full.shorter()
    assert half is not None
    assert list(pairs(half)) == ["p1"]
    assert pairs(half)["p1"] == pairs(full)["p1"]
    assert half.shorter() is None


def test_reason_of_a_model_is_one_short_line(junction: Junction) -> None:
    thoughts = junction.thoughts(*THREE[:2])
    long = "x\n" * 9000
    made, _, _ = coordinator(
        thoughts, lambda q: json.dumps({"orders": [{"pair": "p1", "first": "CAV2", "reason": long}]})
    )
    [p] = again(made, thoughts).precedences
    assert len(p.reason) <= 160
    assert "\n" not in p.reason


def test_answers_are_noted_as_they_came(junction: Junction) -> None:
    thoughts = junction.thoughts(*THREE)
    made, _, ledger = coordinator(thoughts, lambda q: orders(*turned(q)))
    again(made, thoughts)
    [line] = ledger.close_step(2.5)[1]
    assert line["time"] == 2.5
    assert set(line["value"]) == {"reason", "p1", "p2", "p3"}
    assert line["calls"][0]["messages"][1]["content"].startswith("1. State sharing.")
