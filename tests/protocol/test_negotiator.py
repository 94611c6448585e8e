"""What one party answers, proposes and holds."""

from dataclasses import replace

import pytest
from agreeing import coordination, precedence, proposal
from worlds import Junction, car

from codriving.datatypes.cooperation import OrderAgreement, Response
from codriving.protocol.negotiator import Negotiator
from codriving.reasoning.ordering.coordinator import RuleCoordinator
from codriving.reasoning.ordering.problem import pose

# Of these CAV2 can no longer stop before the zone that it shares with CAV1.
LATE = (car("CAV1", "south-north", 60.0, 8.0), car("CAV2", "west-east", 98.0, 8.0))
EARLY = (car("CAV1", "south-north", 40.0, 8.0), car("CAV2", "west-east", 42.0, 8.0))


def party(junction: Junction, name: str, *cars: object, time: float = 0.0, **change: object) -> Negotiator:
    """A party that has looked at a world once, and whose proposals of then have been sent."""
    made = Negotiator(coordination(name, **change), RuleCoordinator(False))
    look(junction, made, *cars, time=time)
    made.speak()
    return made


def look(junction: Junction, made: Negotiator, *cars: object, time: float = 0.0) -> dict[tuple[str, str], str]:
    """Let a party look at a world; return what is agreed on."""
    moment = junction.thoughts(*cars).moment(time)  # type: ignore[arg-type]
    return made.step(moment, pose(moment))


def answer(made: Negotiator, *pairs: str, sender: str = "RSU", to: str = "CAV2", time: float = 0.1) -> Response:
    """What it says to a proposal of these pairs."""
    made.hear([proposal(*pairs, sender=sender, to=(to,))], time)
    [said] = made.speak()
    assert isinstance(said, Response)
    return said


def agreement(*pairs: str, sender: str = "RSU", time: float = 0.2, authority: str = "") -> OrderAgreement:
    """An agreement that holds for 3 s."""
    return OrderAgreement(sender, time, 1, 1, tuple(map(precedence, pairs)), 3.0, authority)


def test_a_cav_accepts_what_it_can_do(junction: Junction) -> None:
    said = answer(party(junction, "CAV2", *EARLY), "CAV1 CAV2")
    assert (said.accepted, said.pairs, said.to, said.number, said.round, said.time) == (True, (), "RSU", 1, 1, 0.1)


def test_a_cav_that_can_no_longer_stop_says_so(junction: Junction) -> None:
    said = answer(party(junction, "CAV2", *LATE), "CAV1 CAV2")
    assert not said.accepted
    assert [(p.first, p.second, p.reason) for p in said.pairs] == [
        ("CAV2", "CAV1", "CAV2 can no longer stop before the conflict zone")
    ]


def test_only_who_is_asked_answers_and_only_as_long_as_the_proposal_holds(junction: Junction) -> None:
    made = party(junction, "CAV2", *EARLY)
    made.hear([proposal("CAV1 CAV2", to=("CAV1",))], 0.1)
    assert made.speak() == []
    made.hear([proposal("CAV1 CAV2", to=("CAV2",))], 3.01)
    assert made.speak() == []
    made.hear([proposal("CAV1 CAV2", to=("CAV2",))], 2.99)
    assert len(made.speak()) == 1


def test_who_has_not_looked_yet_has_nothing_to_say(junction: Junction) -> None:
    made = Negotiator(coordination("CAV2"), RuleCoordinator(False))
    made.hear([proposal("CAV1 CAV2", to=("CAV2",))], 0.1)
    assert made.speak() == []


def test_of_two_proposals_that_contradict_one_another_that_of_the_smaller_name_counts(junction: Junction) -> None:
    # CAV1 has proposed that it goes first.
    made = party(junction, "CAV1", *EARLY, by="distributed")
    said = answer(made, "CAV2 CAV1", sender="CAV2", to="CAV1")
    assert [(p.first, p.second) for p in said.pairs] == [("CAV1", "CAV2")]
    assert said.pairs[0].reason.startswith("CAV1 has proposed otherwise")
    assert answer(made, "CAV1 CAV2", sender="CAV2", to="CAV1").accepted
    # CAV2 has proposed the same, and takes what CAV1 says.
    made = party(junction, "CAV2", *EARLY, by="distributed")
    assert answer(made, "CAV2 CAV1", sender="CAV1", to="CAV2").accepted


def test_the_newer_agreement_of_a_sender_replaces_the_older_one(junction: Junction) -> None:
    made = party(junction, "CAV2", *EARLY)
    made.hear([agreement("CAV1 CAV2", time=0.3)], 0.4)
    made.hear([agreement("CAV2 CAV1", time=0.2)], 0.5)  # Overtaken
    assert look(junction, made, *EARLY, time=0.5).keys() == {("CAV1", "CAV2")}
    made.hear([agreement("CAV2 CAV1", time=0.4)], 0.6)
    assert look(junction, made, *EARLY, time=0.6).keys() == {("CAV2", "CAV1")}
    assert look(junction, made, *EARLY, time=3.4).keys() == {("CAV2", "CAV1")}
    assert look(junction, made, *EARLY, time=3.41) == {}


def test_who_has_accepted_to_be_second_is_so_before_it_hears_of_the_agreement(junction: Junction) -> None:
    made = party(junction, "CAV2", *EARLY)
    made.hear([agreement("CAV2 CAV1", "CAV3 CAV2", time=0.2)], 0.3)
    assert made.agreed(0.4).keys() == {("CAV2", "CAV1"), ("CAV3", "CAV2")}
    made.hear([replace(proposal("CAV1 CAV2", to=("CAV2",)), number=2, time=0.4)], 0.5)
    assert made.agreed(0.5) == {
        ("CAV1", "CAV2"): "promised to RSU: told so",
        ("CAV3", "CAV2"): "agreed with RSU: told so",
    }
    # What was agreed on before, and arrives late, changes nothing.
    made.hear([agreement("CAV2 CAV1", time=0.35)], 0.6)
    assert made.agreed(0.6).keys() == {("CAV1", "CAV2")}
    # Nor does a newer one that leaves the pair open.
    made.hear([replace(agreement("CAV3 CAV2", time=0.6), number=2)], 0.65)
    assert made.agreed(0.65).keys() == {("CAV1", "CAV2"), ("CAV3", "CAV2")}
    # It has heard of no agreement for as long as one may hold.
    assert made.agreed(6.4).keys() == {("CAV1", "CAV2")}
    assert made.agreed(6.5) == {}
    made.hear([replace(agreement("CAV2 CAV1", time=0.7), number=2)], 0.8)
    assert made.agreed(0.8).keys() == {("CAV2", "CAV1")}


def test_who_has_accepted_to_be_first_waits_for_the_agreement(junction: Junction) -> None:
    made = party(junction, "CAV1", *EARLY)
    made.hear([replace(agreement("CAV2 CAV1", time=0.2), number=0)], 0.3)
    assert answer(made, "CAV1 CAV2", to="CAV1", time=0.5).accepted
    assert made.agreed(0.6).keys() == {("CAV2", "CAV1")}
    # Nor does one promise what it has rejected.
    late = party(junction, "CAV2", *LATE)
    assert not answer(late, "CAV1 CAV2").accepted
    assert late.agreed(0.2) == {}


def test_of_the_agreements_of_several_the_newer_one_counts_pair_by_pair(junction: Junction) -> None:
    made = party(junction, "CAV2", *EARLY)
    made.hear([agreement("CAV1 CAV2", "CAV3 CAV2", sender="CAV1", time=0.2)], 0.3)
    made.hear([agreement("CAV2 CAV1", sender="CAV5", time=0.25)], 0.3)
    assert made.agreed(0.5).keys() == {("CAV2", "CAV1"), ("CAV3", "CAV2")}


def test_an_agreement_ends_in_time_where_a_party_does_not_look_at_each_step(junction: Junction) -> None:
    made = party(junction, "CAV2", *EARLY)
    made.hear([agreement("CAV1 CAV2", time=0.2)], 0.3)
    moment = junction.thoughts(*EARLY).moment(3.3)
    problem = pose(moment)
    assert ("CAV1", "CAV2") in made.with_agreed(problem, 3.2).instance.before
    assert ("CAV1", "CAV2") not in made.with_agreed(problem, 3.3).instance.before


def test_what_has_become_impossible_is_told_to_the_one_that_coordinates(junction: Junction) -> None:
    made = party(junction, "CAV2", *EARLY)
    made.hear([agreement("CAV1 CAV2")], 0.3)
    look(junction, made, *EARLY, time=0.5)
    assert made.speak() == []
    look(junction, made, *LATE, time=1.0)
    [said] = made.speak()
    assert isinstance(said, Response)
    assert (said.accepted, said.to, [(p.first, p.second) for p in said.pairs]) == (False, "RSU", [("CAV2", "CAV1")])
    # An instruction is not answered.
    made = party(junction, "CAV2", *LATE)
    made.hear([agreement("CAV1 CAV2", authority="a road side unit")], 0.3)
    look(junction, made, *LATE, time=0.5)
    assert made.speak() == []


@pytest.mark.parametrize(
    ("heard", "coordinates"),
    [
        ({}, {"CAV2"}),  # The nearest to the middle
        ({"CAV1": 0.5}, {"CAV1"}),
        ({"CAV1": 0.5, "CAV2": 0.5}, {"CAV1"}),  # The smaller name
        ({"CAV9": 0.5}, {"CAV2"}),  # That one has left
        ({"CAV1": -2.6}, {"CAV2"}),  # Too long ago
    ],
)
def test_which_cav_coordinates(junction: Junction, heard: dict[str, float], coordinates: set[str]) -> None:
    found = set()
    for name in ("CAV1", "CAV2"):
        made = Negotiator(coordination(name, by="cav"), RuleCoordinator(False))
        for sender, time in heard.items():
            made.hear([agreement(sender=sender, time=time)], time)
        look(junction, made, *EARLY, time=0.5)
        found |= {name for _ in made.speak()}
    assert found == coordinates


def test_one_without_a_conflict_ahead_coordinates_no_more(junction: Junction) -> None:
    # CAV2 is past the junction; CAV1 has a conflict with CAV3 alone.
    there = (EARLY[0], car("CAV2", "west-east", 125.0, 8.0), car("CAV3", "west-east", 20.0, 8.0))
    made = party(junction, "CAV2", *EARLY, by="cav")
    look(junction, made, *there, time=0.5)
    assert made.speak() == []
    made = Negotiator(coordination("CAV1", by="cav"), RuleCoordinator(False))
    look(junction, made, *there, time=0.5)
    assert len(made.speak()) == 1


def test_a_promise_that_can_no_longer_be_kept_is_taken_back(junction: Junction) -> None:
    made = party(junction, "CAV2", *EARLY)
    assert answer(made, "CAV1 CAV2").accepted
    look(junction, made, *LATE, time=0.5)
    [said] = made.speak()
    assert isinstance(said, Response)
    assert (said.to, said.number, said.round, said.accepted) == ("RSU", 1, 1, False)
    assert [(p.first, p.second) for p in said.pairs] == [("CAV2", "CAV1")]
