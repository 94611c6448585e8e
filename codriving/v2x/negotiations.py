"""The negotiations of an episode: who takes part in them, and what they say to one another on the air."""

from collections.abc import Mapping
from typing import Any

from codriving.datatypes import Coordination, Method, OrderAgreement, WorldState
from codriving.geometry import RoadMap
from codriving.v2x.channel import Channel, Place
from codriving.v2x.exchange import Exchange
from codriving.v2x.junction import centre
from codriving.v2x.settings import OrderSettings

AT_THE_ROAD = "RSU"  # The unit that stands in the middle of the junction

COORDINATORS = {"road_side_unit": AT_THE_ROAD, "fleet": "fleet"}  # Parties that are no CAV, by setting


def units(settings: OrderSettings, road_map: RoadMap) -> dict[str, Place | None]:
    """Return who coordinates and is no CAV, and where [m]; None for one that reaches all CAVs."""
    unit = COORDINATORS.get(settings.by)
    if unit is None:
        return {}
    return {unit: centre(road_map) if unit == AT_THE_ROAD else None}


def coordination(settings: OrderSettings, party: str, middle: Place = (0.0, 0.0)) -> Coordination:
    """Return how one party agrees with others."""
    by = COORDINATORS.get(settings.by, settings.by)
    return Coordination(party, by, settings.rounds, settings.validity, middle, settings.emergency or "")


class Negotiations:
    """Carries what copies of a method say to one another about orders."""

    def __init__(self, settings: OrderSettings, channel: Channel, road_map: RoadMap) -> None:
        self.settings = settings
        self.unit = COORDINATORS.get(settings.by)
        self.exchange = Exchange(channel, settings)
        self._middle, self._time = centre(road_map), -1.0

    def join(self, name: str, copy: Method) -> None:
        """Let a copy take part as the one whose name is given."""
        copy.cooperate(coordination(self.settings, name, self._middle))

    def deliver(self, world: WorldState, copies: Mapping[str, Method]) -> None:
        """Hand over what has arrived, and send what is answered to that."""
        if world.time <= self._time:
            return
        # What is answered now arrives at the next simulation step at the earliest.
        self._time = world.time
        for receiver, message in self.exchange.arrived(world.time):
            copy = copies.get(receiver)
            if copy is not None and copy.party is not None and (receiver in world.intents or receiver == self.unit):
                copy.party.hear([message], world.time)
                self.collect(copy, world)

    def collect(self, copy: Method, world: WorldState) -> None:
        """Send what a copy has to say."""
        for message in copy.party.speak() if copy.party is not None else ():
            self.exchange.send(message, world)

    def noted(self, copies: Mapping[str, Method]) -> tuple[dict[str, float], dict[str, Any]]:
        """Return what has been counted and said since the last step, and what each CAV holds."""
        exchange = self.exchange
        held = {name: _held(name, copy) for name, copy in copies.items()}
        counts: dict[str, float] = {"messages": exchange.messages, "message_bytes": exchange.bytes}
        counts |= {"order_messages": exchange.messages, "order_bytes": exchange.bytes}
        counts |= {"rejections": exchange.rejections, "agreed_decisions": sum(map(bool, held.values()))}
        said = {"said": exchange.said, "held": held}
        exchange.said, exchange.messages, exchange.bytes, exchange.rejections = [], 0, 0, 0
        return counts, said


def _held(name: str, copy: Method) -> list[dict[str, Any]]:
    """Write down the agreements that a CAV holds about itself."""
    held = copy.party.held if copy.party is not None else {}
    return [_written(a) for _, a in sorted(held.items()) if any(name in (p.first, p.second) for p in a.pairs)]


def _written(agreement: OrderAgreement) -> dict[str, Any]:
    told = {"sender": agreement.sender, "number": agreement.number, "round": agreement.round}
    told |= {"time": round(agreement.time, 6), "until": round(agreement.time + agreement.validity, 6)}
    told |= {"authority": agreement.authority} if agreement.authority else {}
    return {**told, "pairs": [[p.first, p.second, p.reason] for p in agreement.pairs]}
