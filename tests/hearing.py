"""A channel and what one CAV knows through it, in worlds made by hand."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from worlds import Car, Junction

from codriving.datatypes.parts import Shares
from codriving.datatypes.world import WorldState
from codriving.v2x.channel import Channel
from codriving.v2x.knowledge import KnownWorld
from codriving.v2x.misbehaviour import Misconduct
from codriving.v2x.settings import ChannelSettings

FLAWLESS: dict[str, Any] = {
    "rate": 10.0,
    "age": 0.0,
    "age_shape": 0.0,
    "loss": 0.0,
    "burst": 1.0,
    "range": 10_000.0,
    "noise": 0.0,
    "speed_noise": 0.0,
    "validity": 3.0,
    "cam_bytes": 350,
    "cpm_bytes": 240,
    "object_bytes": 35,
    "mcm_bytes": 300,
}
"""A channel without a flaw."""

ALL = Shares(states=True, intents=True)


def channel_settings(**change: Any) -> ChannelSettings:
    """A flawless channel, but for what is named."""
    return ChannelSettings(**{**FLAWLESS, **change})


@dataclass
class Radio:
    """A channel and one CAV that listens."""

    junction: Junction
    settings: ChannelSettings = field(default_factory=channel_settings)
    shares: Shares = ALL
    ego: str = "CAV1"
    seed: int = 3

    def __post_init__(self) -> None:
        j = self.junction
        self.misconduct = Misconduct(self.settings.misbehaviour, j.road_map, j.model, self.seed)
        self.channel = Channel(self.settings, self.shares, j.model, self.seed, self.misconduct)
        self.known = KnownWorld(self.ego, self.settings, j.road_map, j.model)

    def send(self, time: float, *cars: Car, hidden: tuple[tuple[str, str], ...] = ()) -> WorldState:
        """Let all send what is due in a world."""
        world = self.world(time, *cars, hidden=hidden)
        self.channel.hear(world)
        return world

    def look(self, time: float, *cars: Car, hidden: tuple[tuple[str, str], ...] = ()) -> WorldState:
        """What the CAV knows of a world by then."""
        self.known.hear(self.channel.received(self.ego, time), time)
        return self.known.of(self.world(time, *cars, hidden=hidden))

    def world(self, time: float, *cars: Car, hidden: Iterable[tuple[str, str]] = ()) -> WorldState:
        """A world, with buildings between some."""
        made = self.junction.world(*cars, time=time)
        return WorldState(
            made.time, made.step, made.vehicles, made.intents, made.available, made.signals, tuple(hidden)
        )
