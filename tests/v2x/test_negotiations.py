"""Orders that are agreed on by messages: what is said, what a lost message changes, and what each CAV holds."""

import pytest
from agreeing import Talk, codriving
from worlds import Car, Junction, car

from codriving.datatypes.cooperation import OrderAgreement, OrderMessage, Proposal, Response
from codriving.errors import ConfigError

# Either can stop; the road side unit lets CAV1 go first, and by their own estimates both would.
PAIR = (car("CAV1", "south-north", 40.0, 8.0), car("CAV2", "west-east", 42.0, 8.0))


def test_both_hold_what_both_have_accepted(junction: Junction) -> None:
    talk = Talk(junction, PAIR)
    talk.until(2)
    assert (talk.holds("CAV1", "CAV2"), talk.holds("CAV2", "CAV1")) == ("CAV1", "CAV2")
    made = talk.decide()
    assert (talk.holds("CAV1", "CAV2"), talk.holds("CAV2", "CAV1")) == ("CAV1", "CAV1")
    assert talk.kinds() == [
        ("proposal", "RSU", 1, 1),
        ("acceptance", "CAV1", 1, 1),
        ("acceptance", "CAV2", 1, 1),
        ("agreement", "RSU", 1, 1),
        ("agreement", "RSU", 1, 1),
    ]
    proposal, _, answer, agreement, _ = talk.said
    assert proposal["arrives"] == {"CAV1": pytest.approx(0.633333), "CAV2": pytest.approx(0.633333)}
    # Answered at the simulation step after it has arrived.
    assert answer["time"] == pytest.approx(0.666667)
    assert agreement["time"] == pytest.approx(0.8)
    [held] = made.as_dict()["cavs"][1]["agreements"]
    assert (held["sender"], held["number"], held["until"]) == ("RSU", 1, pytest.approx(3.8))
    assert [pair[:2] for pair in held["pairs"]] == [["CAV1", "CAV2"]]
    reasons = [p.reason for p in talk.situation("CAV2").order.precedences]
    assert reasons == ["agreed with RSU: CAV1 can be there earlier (6.8 s against 7.0 s)"]
    assert not talk.situation("CAV2").order.binding


@pytest.mark.parametrize(
    ("lost", "to", "held"),
    [
        (Proposal, "CAV2", ("CAV1", "CAV2")),
        # Who has accepted to be second is so without an agreement, too.
        (Response, "RSU", ("CAV1", "CAV1")),
        (OrderAgreement, "CAV2", ("CAV1", "CAV1")),
        (OrderAgreement, "CAV1", ("CAV1", "CAV1")),
    ],
)
def test_a_lost_proposal_lets_both_go_first_and_no_other_lost_message_does(
    junction: Junction, lost: type, to: str, held: tuple[str, str]
) -> None:
    def loses(message: OrderMessage, receiver: str) -> bool:
        return isinstance(message, lost) and receiver == to

    talk = Talk(junction, PAIR, loses=loses)
    talk.until(5)
    assert (talk.holds("CAV1", "CAV2"), talk.holds("CAV2", "CAV1")) == held


def test_without_an_agreement_with_one_that_did_not_get_it_two_hold_different_orders(junction: Junction) -> None:
    talk = Talk(junction, PAIR, loses=lambda m, to: isinstance(m, OrderAgreement) and to == "CAV2")
    entries = {entry["id"]: entry for entry in talk.until(4).as_dict()["cavs"]}
    assert len(entries["CAV1"]["agreements"]) == 1
    assert entries["CAV2"]["agreements"] == []
    assert talk.said[-1]["arrives"]["CAV2"] is not None  # Lost by the test, not by the channel


def test_what_was_not_answered_is_said_again(junction: Junction) -> None:
    talk = Talk(junction, PAIR, loses=lambda m, to: isinstance(m, Proposal) and to == "CAV2" and m.time < 1.0)
    talk.until(5)
    assert [line["arrives"].keys() for line in talk.said if line["kind"] == "proposal"] == [
        {"CAV1", "CAV2"},
        {"CAV2"},
    ]
    assert talk.holds("CAV2", "CAV1") == "CAV1"


def test_an_agreement_holds_until_it_expires(junction: Junction) -> None:
    # 1.2 s after 1.07 s, when the last one that arrives was made.
    slow = tuple(car(c.id, c.route, c.place, 4.0, 8.0) for c in PAIR)
    talk = Talk(junction, slow, orders={"validity": 1.2}, loses=lambda m, to: m.time > 1.1 and to == "CAV2")
    talk.until(4)
    held = []
    for _ in range(3):
        talk.decide()
        held.append(talk.holds("CAV2", "CAV1"))
    # At 2.13, 2.67 and 3.2 s.
    assert held == ["CAV1", "CAV2", "CAV2"]


def test_an_order_that_is_late_for_a_decision_holds_from_the_next_one_on(junction: Junction) -> None:
    talk = Talk(junction, PAIR, channel={"age": 0.2})
    talk.decide()
    held = []
    for _ in range(3):
        talk.decide()
        [precedence] = talk.situation("CAV2").order.precedences
        held.append((precedence.first, precedence.reason.partition(":")[0]))
    assert held == [("CAV2", held[0][1]), ("CAV1", "promised to RSU"), ("CAV1", "agreed with RSU")]
    assert "RSU" not in held[0][1]


def test_who_is_out_of_range_of_the_unit_agrees_on_nothing(junction: Junction) -> None:
    # The middle is 70 m from either; the fleet's centre hears them wherever they are.
    for by, said in (("road_side_unit", 0), ("fleet", 4)):
        talk = Talk(junction, PAIR, orders={"by": by}, channel={"range": 50.0})
        talk.until(3)
        assert len(set(talk.kinds())) == said


def test_messages_are_counted(junction: Junction) -> None:
    talk = Talk(junction, PAIR)
    talk.until(2)
    counts = talk.decide().counts
    # Two acceptances without pairs and two agreements on one; the proposal counts with the step before.
    assert (counts["order_messages"], counts["order_bytes"]) == (4, 2 * 250 + 2 * 260)
    assert (counts["rejections"], counts["agreed_decisions"]) == (0, 2)
    assert counts["messages"] == 4 + 2 * 3 * 5


def test_the_cav_nearest_to_the_middle_coordinates(junction: Junction) -> None:
    talk = Talk(junction, PAIR, orders={"by": "cav"})
    talk.until(4)
    assert {sender for kind, sender, _, _ in talk.kinds() if kind == "proposal"} == {"CAV2"}
    assert (talk.holds("CAV1", "CAV2"), talk.holds("CAV2", "CAV1")) == ("CAV1", "CAV1")


def test_each_proposes_to_the_other_if_none_coordinates(junction: Junction) -> None:
    talk = Talk(junction, PAIR, orders={"by": "distributed"})
    talk.until(3)
    assert {sender for kind, sender, _, _ in talk.kinds() if kind == "proposal"} == {"CAV1", "CAV2"}
    assert (talk.holds("CAV1", "CAV2"), talk.holds("CAV2", "CAV1")) == ("CAV1", "CAV1")


def test_an_instruction_binds_who_receives_it(junction: Junction) -> None:
    def loses(message: OrderMessage, receiver: str) -> bool:
        return receiver == "CAV1"

    talk = Talk(junction, PAIR, codriving(binding=True), loses, orders={"emergency": "CAV2"})
    talk.until(3)
    assert {kind for kind, _, _, _ in talk.kinds()} == {"instruction"}
    assert {line["authority"] for line in talk.said} == {"a road side unit"}
    order = talk.situation("CAV2").order
    assert (order.binding, order.first_of("CAV1", "CAV2")) == (True, "CAV2")
    assert [p.reason for p in order.precedences] == ["directed by RSU, a road side unit: CAV2 is an emergency vehicle"]
    # Who did not get it drives as in class B.
    order = talk.situation("CAV1").order
    assert (order.binding, order.first_of("CAV1", "CAV2")) == (False, "CAV1")


@pytest.mark.parametrize("by", ["cav", "distributed"])
def test_only_a_unit_may_direct(junction: Junction, by: str) -> None:
    with pytest.raises(ConfigError, match=r"has none; choose v2x\.coordination\.by=road_side_unit or fleet"):
        Talk(junction, PAIR, codriving(binding=True), orders={"by": by})


@pytest.mark.parametrize("by", ["none", "road_side_unit"])
def test_no_order_is_sent_where_none_is_negotiated(junction: Junction, by: str) -> None:
    talk = Talk(junction, PAIR, codriving(negotiation=by == "none"), orders={"by": by})
    assert talk.connected._negotiations is None


def cars(*others: Car) -> tuple[Car, ...]:
    """The pair, and others."""
    return (*PAIR, *others)


def test_a_unit_knows_what_cavs_tell_it_and_decides_for_none(junction: Junction) -> None:
    talk = Talk(junction, cars(car("HDV1", "north-south", 40.0, 8.0), car("HDV2", "south-north", 60.0, 8.0)))
    talk.until(2)
    known = talk.connected._knowledge["RSU"].of(talk._world())
    assert known.deciding == ()
    # CAV1 sees the driver ahead of it, and no CAV the one that comes from the north.
    assert [v.id for v in known.vehicles] == ["CAV1", "CAV2", "HDV2"]
