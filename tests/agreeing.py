"""CAVs that agree by messages in worlds made by hand, each message delivered or lost as a test says."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import inf
from typing import Any

from worlds import FULL, Car, Junction

from codriving.datatypes.cooperation import Coordination, OrderMessage, Proposal
from codriving.datatypes.order import Precedence
from codriving.datatypes.parts import Method
from codriving.datatypes.situation import Situation
from codriving.llm.language_model import Offline
from codriving.methods.codriving import CoDriving
from codriving.reasoning.sharing.sharing import CdaLevel
from codriving.v2x.connected import V2X, Connected, ConnectedDeliberation
from codriving.v2x.settings import OrderSettings

EXACT: dict[str, Any] = {"rate": 10.0, "age": 0.1, "age_shape": 0.0, "loss": 0.0, "burst": 1.0, "range": 300.0}
EXACT |= {"noise": 0.0, "speed_noise": 0.0, "validity": 3.0}
EXACT |= {"cam_bytes": 350, "cpm_bytes": 240, "object_bytes": 35, "mcm_bytes": 300}
"""A channel that is 0.1 s late and loses nothing."""

ORDERS: dict[str, Any] = {"by": "road_side_unit", "rounds": 3, "validity": 3.0, "emergency": None}
ORDERS |= {"order_bytes": 250, "pair_bytes": 10}

STEP, DECISION = 1 / 15, 8  # Simulation step [s]; so many of them are a decision, a little more than half a second


def codriving(**change: Any) -> CoDriving:
    """The method; toggles that differ from full are named."""
    return CoDriving(CdaLevel(**{**FULL, **change}), Offline(), None, 1.5)


@dataclass
class Talk:
    """Some CAVs at a junction that drive on at their speeds, whatever they decide, and talk meanwhile.

    Attributes:
        loses: Says of a message and a receiver whether it is lost.
    """

    junction: Junction
    cars: tuple[Car, ...]
    method: Method = field(default_factory=codriving)
    loses: Callable[[OrderMessage, str], bool] = lambda message, receiver: False
    orders: dict[str, Any] = field(default_factory=dict)
    channel: dict[str, Any] = field(default_factory=dict)
    shared: tuple[object, ...] = ()

    def __post_init__(self) -> None:
        settings = V2X(**{**EXACT, **self.channel}, coordination=OrderSettings(**{**ORDERS, **self.orders}))
        connected = settings.between(self.method, self.shared)
        assert isinstance(connected, Connected)
        self.connected = connected
        self.connected.reset(self.junction.road_map, self.junction.model, 0)
        self._count = 0
        self.said: list[dict[str, Any]] = []

    def decide(self) -> ConnectedDeliberation:
        """Go on to the next decision."""
        for _ in range(DECISION if self._count else 0):
            self._move()
            self.connected._hear(self._world())
            self._lose()
        made = self.connected.act(self._world())
        self._lose()
        self._count += not self._count
        self.said += made.as_dict().get("said", [])
        self._before = made
        return made

    def until(self, decisions: int) -> ConnectedDeliberation:
        """Go on for some decisions; return the last."""
        for _ in range(decisions - 1):
            self.decide()
        return self.decide()

    def holds(self, ego: str, other: str) -> str | None:
        """Who of two goes first, as the first holds it since the last decision."""
        return self.situation(ego).order.first_of(ego, other)

    def situation(self, ego: str) -> Situation:
        """What a CAV decided by last."""
        return self._before.each[ego].situations[0]  # type: ignore[attr-defined]

    def kinds(self) -> list[tuple[str, str, int, int]]:
        """What was said: its kind, who said it, number and round."""
        return [(line["kind"], line["sender"], line["number"], line["round"]) for line in self.said]

    def _move(self) -> None:
        self.cars = tuple(replace(c, place=c.place + c.speed * STEP) for c in self.cars)
        self._count += 1

    def _world(self) -> Any:
        return self.junction.world(*self.cars, time=max(self._count - 1, 0) * STEP, step=self._count // DECISION)

    def _lose(self) -> None:
        negotiations = self.connected._negotiations
        assert negotiations is not None
        there = negotiations.exchange._under_way
        there[:] = [(inf if self.loses(message, to) else at, k, to, message) for at, k, to, message in there]
        there.sort()


def coordination(name: str, **change: Any) -> Coordination:
    """How a party agrees, with a road side unit unless something else is said."""
    told: dict[str, Any] = {"by": "RSU", "rounds": 3, "validity": 3.0, "centre": (0.0, 0.0), **change}
    return Coordination(name, **told)


def precedence(pair: str) -> Precedence:
    """``"CAV1 CAV2"``: first, then second."""
    return Precedence(*pair.split(), "told so")


def proposal(
    *pairs: str, sender: str = "RSU", to: tuple[str, ...] = (), humans: tuple[str, ...] = (), time: float = 0.0
) -> Proposal:
    """A first proposal, which holds for 3 s."""
    return Proposal(sender, time, 1, 1, tuple(map(precedence, pairs)), to, humans, 3.0)
