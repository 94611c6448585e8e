"""Who is asked for an order, and whose rule orders, where orders are agreed on by messages."""

import pytest
from agreeing import Talk
from asked import Scripted, sensible
from worlds import FULL, Junction, car

from codriving.datatypes.cooperation import OrderAgreement, OrderMessage, Proposal, Response
from codriving.llm.scripted import ScriptedChat
from codriving.methods.codriving import CoDriving
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.methods.ordered import Ordered
from codriving.reasoning.execution.planned import Planned
from codriving.reasoning.ordering.random_order import RandomOrder
from codriving.reasoning.sharing.sharing import CdaLevel

PAIR = (car("CAV1", "south-north", 40.0, 8.0), car("CAV2", "west-east", 42.0, 8.0))


def test_a_model_is_asked_for_an_order_by_the_one_that_coordinates_alone(junction: Junction) -> None:
    chat = ScriptedChat(sensible)
    method = CoDriving(CdaLevel(**FULL), model := Scripted(chat), None, 1.5)
    talk = Talk(junction, PAIR, method, shared=(model,))
    counts = [talk.decide().counts for _ in range(4)]
    assert [q.purpose for q in chat.questions].count("negotiate") == 1
    # From the second decision on, when the road side unit knows them; its answer is kept at the others.
    assert [count.get("kept_orders", 0) for count in counts] == [0, 0, 1, 1]
    [proposal] = [line for line in talk.said if line["kind"] == "proposal"]
    assert [pair[:2] for pair in proposal["pairs"]] == [["CAV1", "CAV2"]]
    assert talk.holds("CAV2", "CAV1") == "CAV1"


def test_an_order_rule_orders_where_it_is_coordinated(junction: Junction) -> None:
    method = CoDriving(CdaLevel(**FULL), Scripted(ScriptedChat(sensible)), None, 1.5, RandomOrder())
    drawn = RandomOrder()
    drawn.reset(0)
    first = min(("CAV1", "CAV2"), key=drawn._place)
    talk = Talk(junction, PAIR, method, shared=(method.llm,))
    talk.until(3)
    [proposal] = [line for line in talk.said if line["kind"] == "proposal"]
    assert proposal["pairs"][0][0] == first
    assert proposal["pairs"][0][2].endswith("was drawn before " + ("CAV2" if first == "CAV1" else "CAV1"))


ONE, OTHER = "who is first by the rule", "the emergency vehicle"


@pytest.mark.parametrize(
    ("lost", "to", "held"),
    [
        (None, None, (OTHER, OTHER)),
        (Proposal, ONE, (ONE, ONE)),
        # Who has accepted is second, and who has heard of no agreement does not go first: they hold different orders.
        (Response, "RSU", (ONE, OTHER)),
        (OrderAgreement, OTHER, (ONE, OTHER)),
        (OrderAgreement, ONE, (OTHER, OTHER)),
    ],
)
def test_a_lost_message_changes_who_goes_first(
    junction: Junction, lost: type | None, to: str | None, held: tuple[str, str]
) -> None:
    """What the emergency vehicle and the other CAV hold where a proposal to let it go first is agreed on, or not."""
    usual = Talk(junction, PAIR, Ordered(FirstComeFirstServed(), Planned(1.0, 1.5, 0.5, 0.8)))
    usual.until(3)
    first = str(usual.holds("CAV1", "CAV2"))
    names = {ONE: first, OTHER: ({"CAV1", "CAV2"} - {first}).pop(), "RSU": "RSU"}

    def loses(message: OrderMessage, receiver: str) -> bool:
        return lost is not None and isinstance(message, lost) and receiver == names[to or ""]

    ordered = Ordered(FirstComeFirstServed(), Planned(1.0, 1.5, 0.5, 0.8))
    talk = Talk(junction, PAIR, ordered, loses, orders={"emergency": names[OTHER]})
    talk.until(3)
    ours, theirs = names[OTHER], names[ONE]
    assert (talk.holds(ours, theirs), talk.holds(theirs, ours)) == tuple(names[name] for name in held)


def test_a_method_that_orders_goes_by_what_is_agreed_on(junction: Junction) -> None:
    def ordered() -> Ordered:
        return Ordered(FirstComeFirstServed(), Planned(1.0, 1.5, 0.5, 0.8))

    talk = Talk(junction, PAIR, ordered())
    talk.until(3)
    [proposal] = [line for line in talk.said if line["kind"] == "proposal"]
    first = proposal["pairs"][0][0]
    assert talk.holds("CAV1", "CAV2") == talk.holds("CAV2", "CAV1") == first
