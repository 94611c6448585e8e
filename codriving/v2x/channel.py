"""The channel of one episode: what is sent at each tick, and what of it has reached whom."""

from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import hypot

from codriving.datatypes import DrivingModel, Shares, VehicleState, WorldState
from codriving.v2x.draws import Errors, Link, tells
from codriving.v2x.messages import (
    CollectivePerception,
    CooperativeAwareness,
    ManoeuvreCoordination,
    PerceivedObject,
    RouteSharing,
    V2xMessage,
)
from codriving.v2x.misbehaviour import Misconduct, with_ghost
from codriving.v2x.settings import ChannelSettings

Place = tuple[float, float]  # x and y [m]

NO_UNITS: Mapping[str, Place | None] = {}


@dataclass(frozen=True, slots=True)
class Packet:
    """What one CAV sends at one tick."""

    sender: str
    time: float  # [s]
    tick: int
    messages: tuple[V2xMessage, ...]
    heard_by: frozenset[str]  # Who is within the range


class Channel:
    """Everything that is on the air."""

    def __init__(
        self,
        settings: ChannelSettings,
        shares: Shares,
        model: DrivingModel,
        seed: int,
        misconduct: Misconduct,
        units: Mapping[str, Place | None] = NO_UNITS,
    ) -> None:
        self.settings, self._shares, self._model, self._seed = settings, shares, model, seed
        self._misconduct = misconduct
        self._units = units  # Who coordinates and is no CAV, and where [m]; None for one that reaches all CAVs
        self._sent: dict[str, deque[Packet]] = {}
        self._links: dict[tuple[str, str], Link] = {}
        self._errors: dict[tuple[str, str], Errors] = {}
        self._tick = -1
        self.messages = self.bytes = 0  # Since they were counted last

    def hear(self, world: WorldState) -> None:
        """Let every CAV, and each human driver who tells a route, send what is due at this time."""
        tick = self.tick_of(world.time)
        if tick == self._tick:
            return
        self._tick = tick
        ghosts = {cav.id: (ghost, speaks) for cav, ghost, speaks in self._misconduct.ghosts(world)}
        for cav in world.cavs:
            messages = self._misconduct.sent(cav, tuple(self._messages(world, cav)), world)
            if cav.id in ghosts and self._shares.states:
                ghost, speaks = ghosts[cav.id]
                if speaks:
                    about = ghost.id, world.time, self.settings.validity
                    self._send(cav, ghost.id, (CooperativeAwareness(*about, self.settings.cam_bytes, ghost),), world)
                else:
                    messages = with_ghost(messages, ghost, self.settings.object_bytes)
            self._send(cav, cav.id, messages, world)
        for human in world.hdvs:
            # Only an observer is shown routes of human drivers.
            if human.id in world.routes and tells(self._seed, human.id, self.settings.telling_humans):
                self._send(human, human.id, tuple(self._told_by(human, world)), world)
        for packets in self._sent.values():
            while packets and packets[0].time < world.time - self.settings.validity - 1e-9:
                packets.popleft()

    def _send(self, cav: VehicleState, sender: str, messages: tuple[V2xMessage, ...], world: WorldState) -> None:
        """Send what a CAV tells, in its own name or another one."""
        self.messages += len(messages)
        self.bytes += sum(message.size for message in messages)
        packet = Packet(sender, world.time, self._tick, messages, frozenset(self.reached(cav.id, world)))
        self._sent.setdefault(sender, deque()).append(packet)

    def _told_by(self, human: VehicleState, world: WorldState) -> Iterator[V2xMessage]:
        about = human.id, world.time, self.settings.validity
        if self._shares.states:
            yield CooperativeAwareness(*about, self.settings.cam_bytes, self._measured(human.id, human))
        if self._shares.intents:
            yield RouteSharing(*about, self.settings.mcm_bytes, world.routes[human.id])

    def reached(self, sender: str, world: WorldState) -> list[str]:
        """Return who is within the range of a sender."""
        places = {**{cav.id: (cav.x, cav.y) for cav in world.cavs}, **self._units}
        here = next(((v.x, v.y) for v in world.vehicles if v.id == sender), self._units.get(sender))
        return [name for name, there in places.items() if name != sender and self._near(here, there)]

    def _near(self, one: Place | None, other: Place | None) -> bool:
        return one is None or other is None or hypot(one[0] - other[0], one[1] - other[1]) <= self.settings.range

    def _messages(self, world: WorldState, cav: VehicleState) -> Iterator[V2xMessage]:
        settings, reach = self.settings, self._model.detection_range
        about = cav.id, world.time, settings.validity
        if self._shares.states:
            yield CooperativeAwareness(*about, settings.cam_bytes, self._measured(cav.id, cav))
            objects = tuple(
                PerceivedObject(self._measured(cav.id, h), world.signals.get(h.id, ""))
                for h in world.hdvs
                if world.senses(cav, h, reach)
            )
            size = settings.cpm_bytes + settings.object_bytes * len(objects)
            yield CollectivePerception(*about, size, objects)
        if self._shares.intents:
            intent, available = world.intents[cav.id], world.available[cav.id]
            yield ManoeuvreCoordination(*about, settings.mcm_bytes, intent, available)

    def tick_of(self, time: float) -> int:
        """Return the tick at or before a time [s]."""
        return int(time * self.settings.rate + 1e-6)

    def link(self, sender: str, receiver: str) -> Link:
        """Return what chance does to messages from one to another."""
        if (sender, receiver) not in self._links:
            self._links[sender, receiver] = Link(self.settings, self._seed, sender, receiver)
        return self._links[sender, receiver]

    def _measured(self, by: str, vehicle: VehicleState) -> VehicleState:
        """Return a state as a CAV writes it into a message."""
        if (by, vehicle.id) not in self._errors:
            self._errors[by, vehicle.id] = Errors(self.settings, self._seed, by, vehicle.id)
        x, y, speed = self._errors[by, vehicle.id].at(self._tick)
        return replace(vehicle, x=vehicle.x + x, y=vehicle.y + y, speed=max(vehicle.speed + speed, 0.0))

    def received(self, receiver: str, time: float) -> list[Packet]:
        """Return the newest packet of each sender that has reached a CAV and is still valid, by sender."""
        found = []
        for sender in sorted(self._sent.keys() - {receiver}):
            link = self.link(sender, receiver)
            newest = (
                packet
                for packet in reversed(self._sent[sender])
                if receiver in packet.heard_by
                and packet.time + link.delay(packet.tick) <= time + 1e-9
                and time - packet.time <= self.settings.validity + 1e-9
            )
            if (packet := next(newest, None)) is not None:
                found.append(packet)
        return found
