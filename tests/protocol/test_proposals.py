"""Round after round: what is proposed, and what of it becomes an agreement."""

from agreeing import coordination, precedence
from worlds import Car, Junction, car

from codriving.datatypes.cooperation import OrderAgreement, OrderMessage, Proposal, Response
from codriving.protocol.proposals import Proposals
from codriving.reasoning.ordering.coordinator import RuleCoordinator
from codriving.reasoning.ordering.problem import pose

FIRST, SECOND = car("CAV1", "south-north", 40.0, 8.0), car("CAV2", "west-east", 42.0, 8.0)
THIRD = car("CAV3", "east-west", 20.0, 8.0)


def proposals(**change: object) -> Proposals:
    """Those of a road side unit."""
    return Proposals(coordination("RSU", **change), RuleCoordinator(False), False, refuse)


def refuse(proposal: Proposal) -> Response:
    """A unit is in no pair, so that it is not asked."""
    raise AssertionError(proposal)


def step(junction: Junction, made: Proposals, time: float, *cars: Car) -> list[OrderMessage]:
    """What is said at a decision."""
    moment = junction.thoughts(*cars).moment(time)
    return made.step(moment, pose(moment))


def said(made: Proposals, sender: str, *instead: str, time: float = 0.2) -> list[OrderMessage]:
    """What an answer to the current proposal leads to: an acceptance, or a rejection with what has to be instead."""
    current = made.current
    assert current is not None
    pairs = tuple(map(precedence, instead))
    return made.hear(Response(sender, time, current.number, current.round, pairs, "RSU", not instead), time)


def pairs(message: OrderMessage) -> list[tuple[str, str]]:
    """The pairs of a message."""
    return [(p.first, p.second) for p in message.pairs]


def test_what_both_have_accepted_is_agreed_on(junction: Junction) -> None:
    made = proposals()
    [proposal] = step(junction, made, 0.0, FIRST, SECOND)
    assert isinstance(proposal, Proposal)
    assert (proposal.to, proposal.number, proposal.round, pairs(proposal)) == (
        ("CAV1", "CAV2"),
        1,
        1,
        [("CAV1", "CAV2")],
    )
    assert said(made, "CAV1") == []
    [agreement] = said(made, "CAV2")
    assert isinstance(agreement, OrderAgreement)
    assert (pairs(agreement), agreement.time, agreement.validity, agreement.authority) == (
        [("CAV1", "CAV2")],
        0.2,
        3.0,
        "",
    )


def test_pairs_are_agreed_on_one_by_one(junction: Junction) -> None:
    made = proposals()
    [proposal] = step(junction, made, 0.0, FIRST, SECOND, THIRD)
    assert set(pairs(proposal)) == {("CAV1", "CAV2"), ("CAV1", "CAV3")}
    said(made, "CAV1")
    said(made, "CAV2")
    again, agreement = step(junction, made, 0.5, FIRST, SECOND, THIRD)
    assert isinstance(again, Proposal)
    assert (again.to, again.time, again.number) == (("CAV3",), 0.5, 1)
    assert pairs(agreement) == [("CAV1", "CAV2")]


def test_a_rejection_is_given_in_the_next_round(junction: Junction) -> None:
    made = proposals()
    step(junction, made, 0.0, FIRST, SECOND)
    said(made, "CAV1")
    [second] = said(made, "CAV2", "CAV2 CAV1")
    assert isinstance(second, Proposal)
    assert (second.number, second.round, pairs(second)) == (1, 2, [("CAV2", "CAV1")])
    assert second.pairs[0].reason == "told so"
    # Answers to the first round come too late.
    current = made.current
    made.hear(Response("CAV1", 0.3, 1, 1, (), "RSU", True), 0.3)
    said(made, "CAV2")
    assert made.current is current
    [agreement] = said(made, "CAV1")
    assert pairs(agreement) == [("CAV2", "CAV1")]
    # It stays so at the next decisions.
    [agreement] = step(junction, made, 0.5, FIRST, SECOND)
    assert pairs(agreement) == [("CAV2", "CAV1")]


def test_a_rejection_is_not_left_waiting_for_who_does_not_answer(junction: Junction) -> None:
    made = proposals()
    step(junction, made, 0.0, FIRST, SECOND)
    assert said(made, "CAV2", "CAV2 CAV1") == []
    [second] = step(junction, made, 0.5, FIRST, SECOND)
    assert (second.round, pairs(second)) == (2, [("CAV2", "CAV1")])


def test_rounds_are_bounded(junction: Junction) -> None:
    made = proposals(rounds=2)
    heard = step(junction, made, 0.0, FIRST, SECOND)
    for k in range(1, 10):
        current = made.current
        assert current is not None
        [(first, second)] = pairs(current)
        said(made, first)
        # Neither wants to go first.
        found = said(made, second, f"{second} {first}", time=k / 2)
        heard += [*found, *step(junction, made, k / 2, FIRST, SECOND)]
    rounds = dict.fromkeys((m.number, m.round) for m in heard if isinstance(m, Proposal))
    # Two proposals in each 3 s.
    assert list(rounds) == [(1, 1), (1, 2), (2, 1), (2, 2)]


def test_a_rejection_of_a_pair_that_is_no_longer_open_is_none(junction: Junction) -> None:
    made = proposals(rounds=1)
    step(junction, made, 0.0, FIRST, SECOND, THIRD)
    said(made, "CAV1")
    said(made, "CAV2")
    said(made, "CAV3", "CAV3 CAV1")
    past = car("CAV3", "east-west", 130.0, 8.0)
    step(junction, made, 0.5, FIRST, SECOND, past)
    [agreement] = step(junction, made, 4.0, FIRST, SECOND, past)
    assert (agreement.number, pairs(agreement)) == (1, [("CAV1", "CAV2")])


def test_what_is_withdrawn_comes_on_top_of_what_was_rejected_before(junction: Junction) -> None:
    made = proposals(rounds=1)
    step(junction, made, 0.0, FIRST, SECOND, THIRD)
    said(made, "CAV2")
    said(made, "CAV1", "CAV3 CAV1")
    [agreement] = said(made, "CAV3")
    assert pairs(agreement) == [("CAV1", "CAV2")]
    # Now CAV1 can keep none of the two, and an acceptance from before comes late.
    assert said(made, "CAV1", "CAV2 CAV1") == []
    assert said(made, "CAV1") == []
    assert step(junction, made, 0.5, FIRST, SECOND, THIRD) == []


def test_an_order_that_changes_is_proposed_anew(junction: Junction) -> None:
    made = proposals()
    step(junction, made, 0.0, FIRST, SECOND)
    said(made, "CAV1")
    said(made, "CAV2")
    [proposal] = step(junction, made, 0.5, FIRST, SECOND, THIRD)
    assert isinstance(proposal, Proposal)
    assert (proposal.number, proposal.round, proposal.to) == (2, 1, ("CAV1", "CAV2", "CAV3"))


def test_who_has_passed_is_asked_no_more(junction: Junction) -> None:
    made = proposals()
    step(junction, made, 0.0, FIRST, SECOND, THIRD)
    said(made, "CAV1")
    said(made, "CAV2")
    past = car("CAV3", "east-west", 130.0, 8.0)
    [agreement] = step(junction, made, 0.5, FIRST, SECOND, past)
    assert pairs(agreement) == [("CAV1", "CAV2")]
    assert step(junction, made, 1.0, FIRST, past) == []
    assert made.current is None


def test_an_emergency_vehicle_and_who_is_ahead_of_it_go_first(junction: Junction) -> None:
    ahead = car("CAV4", "west-east", 56.0, 8.0)
    [proposal] = step(junction, proposals(emergency="CAV2"), 0.0, FIRST, SECOND, ahead)
    assert {(p.first, p.second): p.reason for p in proposal.pairs if "emergency" in p.reason} == {
        ("CAV2", "CAV1"): "CAV2 is an emergency vehicle",
        ("CAV4", "CAV1"): "CAV4 is ahead of CAV2 in emergency",
    }


def test_an_emergency_vehicle_does_not_go_before_who_can_no_longer_stop(junction: Junction) -> None:
    late = car("CAV1", "south-north", 96.0, 8.0)
    [proposal] = step(junction, proposals(emergency="CAV2"), 0.0, late, SECOND)
    assert pairs(proposal) == [("CAV1", "CAV2")]


def test_with_an_authority_what_is_ordered_is_an_instruction(junction: Junction) -> None:
    made = proposals(authority="a road side unit")
    [instruction] = step(junction, made, 0.0, FIRST, SECOND)
    assert isinstance(instruction, OrderAgreement)
    assert (instruction.authority, pairs(instruction)) == ("a road side unit", [("CAV1", "CAV2")])
    assert made.current is None
