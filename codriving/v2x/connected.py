"""A method whose CAVs hear of one another by messages: one copy a CAV, which decides by what that one knows."""

from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from codriving.datatypes import (
    UNITS,
    Account,
    Action,
    Communication,
    Deliberation,
    DrivingModel,
    Manner,
    Method,
    Outcome,
    WorldState,
    Wrapped,
)
from codriving.geometry import RoadMap
from codriving.v2x.channel import Channel
from codriving.v2x.knowledge import KnownWorld
from codriving.v2x.misbehaviour import Misconduct
from codriving.v2x.negotiations import Negotiations, coordination, units
from codriving.v2x.plausibility import Plausibility
from codriving.v2x.settings import NONE, ChannelSettings


@dataclass(frozen=True, slots=True)
class ConnectedDeliberation(Deliberation):
    """A decision step in which each CAV has decided for itself."""

    time: float  # Simulated time [s]
    step: int
    each: Mapping[str, Deliberation]  # By id of the CAV
    counts: Mapping[str, float]
    transcript: tuple[dict[str, Any], ...]
    said: Mapping[str, Any] | None = None  # Messages about orders, and what each CAV holds; None where none are sent

    @property
    def actions(self) -> dict[str, Action]:
        return {name: deliberation.actions[name] for name, deliberation in self.each.items()}

    def as_dict(self) -> dict[str, Any]:
        cavs = [
            entry
            for name, deliberation in self.each.items()
            for entry in deliberation.as_dict()["cavs"]
            if entry["id"] == name
        ]
        line = {"time": self.time, "step": self.step, "cavs": cavs}
        if self.said is None:
            return line
        for entry in cavs:
            entry["agreements"] = self.said["held"][entry["id"]]
        return {**line, "said": self.said["said"]}


class V2X(ChannelSettings, Communication):
    """What ``v2x=`` chooses."""

    def between(self, method: Method, shared: Sequence[object]) -> Method:
        """Return the method with a copy for each CAV; the method itself if its CAVs tell one another nothing."""
        told = method.shares
        return Connected(method, self, shared) if told.states or told.intents else method

    def notes(self, method: Method, brief: bool) -> tuple[str, ...]:
        if not isinstance(method, Connected):
            return ("v2x={v2x} has no effect on {}: the CAVs tell one another nothing.",)
        said = "" if brief else f" ({self})"
        return (f"v2x={{v2x}}{said}: each CAV of {{}} decides by what it sees and what messages have told it.",)


class Connected(Wrapped):
    """A method, copied for each CAV, and the channel between the copies."""

    def __init__(self, method: Method, settings: ChannelSettings, shared: Sequence[object]) -> None:
        super().__init__(method)
        self.settings, self._shared = settings, shared
        self.observer = self._hear
        self._misbehaving: dict[str, str] = {}
        orders = settings.coordination
        self._orders = orders if method.shares.orders and orders is not None and orders.by != NONE else None
        if self._orders is not None:
            method.cooperate(coordination(self._orders, ""))  # Refuses what cannot be before anything is driven

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode; every CAV begins with what it sees and what it has heard at its first step."""
        self._begin, self._misbehaving = (road_map, model, seed), {}
        self._misconduct = Misconduct(self.settings.misbehaviour, road_map, model, seed)
        self._checks: dict[str, Plausibility] = {}
        orders = self._orders
        there = units(orders, road_map) if orders else {}
        self._channel = Channel(self.settings, self.shares, model, seed, self._misconduct, there)
        self._negotiations = Negotiations(orders, self._channel, road_map) if orders else None
        self._knowledge: dict[str, KnownWorld] = {}
        self._copies: dict[str, Method] = {}
        self._manners: Mapping[str, Manner] = {}

    def _hear(self, world: WorldState) -> None:
        self._channel.hear(world)
        if self._negotiations is not None:
            self._negotiations.deliver(world, {n: copy for n, copy in self._copies.items() if self._answers(n)})

    def be_told(self, manners: Mapping[str, Manner]) -> None:
        self._manners = manners

    def act(self, world: WorldState) -> ConnectedDeliberation:
        """Let each CAV on the road decide by what it knows."""
        negotiations = self._negotiations
        self._hear(world)
        made: list[Deliberation] = []
        if negotiations is not None and negotiations.unit is not None:
            made.append(self._decided(negotiations.unit, self._known(negotiations.unit, world, {}), world))
        each: dict[str, Deliberation] = {}
        ages, uses = 0.0, 0
        rejected = {"messages_rejected": 0.0, "messages_rejected_honest": 0.0} if self.settings.plausibility else {}
        for cav in world.cavs:
            known = self._known(cav.id, world, rejected)
            if kind := self._misconduct.kind_of(cav.id):
                self._misbehaving[cav.id] = kind
            if kind == "does_not_yield":
                known = self._misconduct.pushing(known)
            each[cav.id] = self._decided(cav.id, known, world)
            used = [age for told in known.told.values() for age in (told.intent_age, None if told.seen else told.age)]
            ages, uses = ages + sum(age for age in used if age is not None), uses + len(used) - used.count(None)
        counts: dict[str, float] = {}
        made += each.values()
        counted, said = (None, None) if negotiations is None else negotiations.noted({n: self._copies[n] for n in each})
        told = {**self._sent()[0], "message_age": round(ages, 9), "message_uses": uses}
        for found in (*(deliberation.counts for deliberation in made), told, rejected, counted or {}):
            for name, number in found.items():
                counts[name] = counts.get(name, 0) + number
        transcript = tuple(line for deliberation in made for line in deliberation.transcript)
        return ConnectedDeliberation(world.time, world.step, each, counts, transcript, said)

    def _known(self, name: str, world: WorldState, rejected: dict[str, float]) -> WorldState:
        """Return what a CAV, or a unit, knows of a world.

        Args:
            rejected: Counts the messages that a CAV does not believe; empty for one that believes all.
        """
        knowledge, packets = self._knowledge_of(name), self._channel.received(name, world.time)
        if rejected:
            packets, doubted = self._check(name).believed(packets, world)
            for packet in doubted:
                there = packet.sender in {v.id for v in world.vehicles}
                honest = there and not (packet.sender in world.intents and self._misconduct.kind_of(packet.sender))
                rejected["messages_rejected"] += len(packet.messages)
                rejected["messages_rejected_honest"] += honest * len(packet.messages)
        knowledge.hear(packets, world.time)
        return knowledge.of(world)

    def _decided(self, name: str, known: WorldState, world: WorldState) -> Deliberation:
        copy = self._copy(name)
        if copy.knows_drivers:
            copy.be_told(self._manners)
        deliberation = copy.act(known)
        if self._negotiations is not None and self._answers(name):
            self._negotiations.collect(copy, world)
        return deliberation

    def _answers(self, name: str) -> bool:
        # Of all that take part only CAVs misbehave: no unit that coordinates is drawn for it.
        return name in UNITS or self._misconduct.kind_of(name) != "never_answers"

    def conclude(self, world: WorldState, outcome: Outcome) -> Account:
        counts, lines = _together([self._sent(), *(copy.conclude(world, outcome) for copy in self._copies.values())])
        if any(self.settings.misbehaviour.shares.values()):
            cavs = [name for name in outcome.failed if name in self._copies]
            misbehave = any(name in self._misbehaving for name in cavs)
            crash = outcome.collision is not None
            counts |= {"misbehaving": len(self._misbehaving), "collisions_with_misbehaving": int(crash and misbehave)}
            counts |= {"collisions_of_honest": int(crash and bool(cavs) and not misbehave)}
        return counts, lines

    @property
    def misbehaving(self) -> Mapping[str, str]:
        return self._misbehaving

    def _check(self, name: str) -> Plausibility:
        if name not in self._checks:
            road_map, model, _ = self._begin
            self._checks[name] = Plausibility(self._knowledge_of(name), self.settings, road_map, model)
        return self._checks[name]

    def unfinished_step(self, time: float) -> Account:
        return _together([self._sent(), *(copy.unfinished_step(time) for copy in self._copies.values())])

    def _sent(self) -> Account:
        """Count what has been sent since the last decision."""
        counts: dict[str, float] = {"messages": self._channel.messages, "message_bytes": self._channel.bytes}
        self._channel.messages = self._channel.bytes = 0
        return counts, []

    def _knowledge_of(self, name: str) -> KnownWorld:
        if name not in self._knowledge:
            road_map, model, _ = self._begin
            self._knowledge[name] = KnownWorld(name, self.settings, road_map, model)
        return self._knowledge[name]

    def _copy(self, name: str) -> Method:
        if name not in self._copies:
            self._copies[name] = deepcopy(self.method, {id(part): part for part in self._shared})
            if self._negotiations is not None:
                self._negotiations.join(name, self._copies[name])
            self._copies[name].reset(*self._begin)
        return self._copies[name]


def _together(accounts: Sequence[Account]) -> Account:
    counts: dict[str, float] = {}
    for found, _ in accounts:
        for name, number in found.items():
            counts[name] = counts.get(name, 0) + number
    return counts, [line for _, lines in accounts for line in lines]
