"""The messages about orders that are on the air, on the same links as all others."""

from heapq import heappop, heappush
from math import isfinite
from typing import Any

from codriving.datatypes import OrderAgreement, OrderMessage, Proposal, Response, WorldState
from codriving.v2x.channel import Channel
from codriving.v2x.settings import OrderSettings


class Exchange:
    """What is under way, and what has been said since the last decision."""

    def __init__(self, channel: Channel, settings: OrderSettings) -> None:
        self._channel, self._settings = channel, settings
        self._under_way: list[tuple[float, int, str, OrderMessage]] = []
        self._count = 0
        self.messages = self.bytes = self.rejections = 0  # Since they were counted last
        self.said: list[dict[str, Any]] = []  # Lines for ``decisions.jsonl``, likewise

    def send(self, message: OrderMessage, world: WorldState) -> None:
        """Send a message to all within the range."""
        channel, settings = self._channel, self._settings
        tick = channel.tick_of(world.time)
        arrivals = {}
        for receiver in channel.reached(message.sender, world):
            arrives = world.time + channel.link(message.sender, receiver).delay(tick)
            if isfinite(arrives):
                arrivals[receiver] = arrives
                heappush(self._under_way, (arrives, self._count, receiver, message))
                self._count += 1
        self.messages += 1
        self.bytes += settings.order_bytes + settings.pair_bytes * len(message.pairs)
        self.rejections += isinstance(message, Response) and not message.accepted
        self.said.append(_line(message, arrivals))

    def arrived(self, time: float) -> list[tuple[str, OrderMessage]]:
        """Return what has arrived by a time [s], each with its receiver."""
        found = []
        while self._under_way and self._under_way[0][0] <= time + 1e-9:
            _, _, receiver, message = heappop(self._under_way)
            found.append((receiver, message))
        return found


def _line(message: OrderMessage, arrivals: dict[str, float]) -> dict[str, Any]:
    """Write down who said what to whom, and when it arrives there; None if it does not."""
    if isinstance(message, Proposal):
        kind, to = "proposal", list(message.to)
    elif isinstance(message, Response):
        kind, to = "acceptance" if message.accepted else "rejection", [message.to]
    else:
        kind = "instruction" if isinstance(message, OrderAgreement) and message.authority else "agreement"
        names = {name for p in message.pairs for name in (p.first, p.second)}
        to = sorted(names - {message.sender})
    line: dict[str, Any] = {"kind": kind, "sender": message.sender, "time": round(message.time, 6)}
    if isinstance(message, OrderAgreement) and message.authority:
        line["authority"] = message.authority
    line |= {"number": message.number, "round": message.round}
    line["pairs"] = [[p.first, p.second, p.reason] for p in message.pairs]
    line["arrives"] = {name: round(arrivals[name], 6) if name in arrivals else None for name in to}
    return line
