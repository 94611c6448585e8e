"""Styles of human drivers, and a mix of them from which each driver is drawn."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from codriving.datatypes import Drivers
from codriving.environment.settings import DriverProfile
from codriving.errors import ConfigError, require_interval, require_range

Interval = tuple[float, float]

TYPICAL = "attentive"  # The style of which a driver who stands for all others is


@dataclass(frozen=True, slots=True)
class DriverStyle:
    """How the drivers of one kind drive; of an interval each driver has a value of its own, all with equal chances."""

    headway: Interval  # IDM's desired time gap [s]
    acceleration: Interval  # IDM's comfortable acceleration [m/s2]
    deceleration: Interval  # IDM's comfortable deceleration [m/s2]
    speed: Interval  # Factor of the speed that is wanted
    reaction: Interval  # Time from what happens to what the driver does about it [s]
    distraction: float  # How much later it sees who crosses its way; it follows as attentively as the others [s]
    horizon: float  # How far ahead it looks for vehicles that it would meet [s]
    gives_way: Literal["by_rule", "to_higher_rank", "never"]
    hesitation: float  # How long it stands before it takes the right of way that it has [s]
    patience: Interval  # How long it stands before it goes where nothing moves [s]

    def __post_init__(self) -> None:
        for name, low, high, unit in (
            ("headway", 0.1, 5, " s"),
            ("acceleration", 0.1, 10, " m/s2"),
            ("deceleration", 0.1, 10, " m/s2"),
            ("speed", 0.3, 2, ""),
            ("reaction", 0, 3, " s"),
            ("patience", 0, 600, " s"),
        ):
            require_interval(name, getattr(self, name), low, high, unit)
        for name, low, high in (("distraction", 0, 10), ("horizon", 0.25, 6), ("hesitation", 0, 600)):
            require_range(name, getattr(self, name), low, high, " s")


@dataclass(frozen=True, slots=True)
class DriverTraits:
    """What is drawn for one driver."""

    style: str
    profile: DriverProfile
    exponent: float  # Of IDM's acceleration on a free road
    speed: float  # Factor of the speed that is wanted
    reaction: float  # [s]
    distraction: float  # [s]
    horizon: float  # [s]
    gives_way: str
    hesitation: float  # [s]
    patience: float  # [s]
    signals: bool  # Whether it signals its turns


@dataclass(frozen=True, slots=True)
class DriverMix(Drivers):
    """Styles and their shares, and what all drivers have in common.

    Raises:
        ConfigError: If a value is out of range.
    """

    styles: Mapping[str, DriverStyle]
    shares: Mapping[str, float]  # Weight of each style; a style that is not named has none
    signals: float  # Share of drivers who signal their turns
    limit: float  # Hardest acceleration or braking that a driver can do [m/s2]
    jam_distance: float  # Distance between the centres of two standing cars [m]
    sight: float  # How far ahead along the route a driver looks for bodies [m]
    politeness: float
    gain_threshold: float  # MOBIL's smallest gain for a lane change [m/s2]
    safe_braking: float  # MOBIL's hardest braking imposed on the new follower [m/s2]

    def __post_init__(self) -> None:
        require_range("drivers.signals", self.signals, 0, 1)
        for name, share in self.shares.items():
            if name not in self.styles:
                raise ConfigError(f"drivers.shares.{name} is of no style; styles: {', '.join(self.styles)}")
            require_range(f"drivers.shares.{name}", share, 0, 1)
        if not sum(self.shares.values()) > 0:
            raise ConfigError(
                "drivers.shares must have one above 0, got none; set for instance drivers.shares.attentive=1"
            )
        self._profile(1.0, 1.0, 1.0)

    @property
    def weights(self) -> Mapping[str, float]:
        """Weight of each style among those who drive here."""
        return self.shares

    @property
    def acceleration(self) -> float:
        """Hardest acceleration of any driver that the mix can hold [m/s2]."""
        return max(self.styles[name].acceleration[1] for name, share in self.shares.items() if share > 0)

    def draw(self, seed: int, name: str) -> DriverTraits:
        """Draw a driver; seed and name alone tell it, so that one driver does not change the others."""
        key = np.random.SeedSequence(entropy=seed, spawn_key=(2, *name.encode()))
        # All at once and in a fixed order: another share of a style leaves the drivers of the other styles as they are.
        chance = np.random.default_rng(key).random(9).tolist()
        return self._traits(self._kind(chance[0]), chance[1:8], chance[8] < self.signals)

    def typical(self) -> DriverTraits:
        """Return the driver in the middle of the attentive ones, of the first style where none is called so."""
        return self._traits(TYPICAL if TYPICAL in self.styles else next(iter(self.styles)), [0.5] * 7, True)

    def _traits(self, kind: str, chance: Sequence[float], signals: bool) -> DriverTraits:
        """Return the driver of a style whose values lie so far between the ends of their intervals, 0 to 1."""
        style = self.styles[kind]

        def within(interval: Interval, place: float) -> float:
            return interval[0] + (interval[1] - interval[0]) * place

        of = (style.acceleration, style.deceleration, style.headway, (3.5, 4.5), style.speed, style.reaction)
        acceleration, deceleration, headway, exponent, speed, reaction = map(within, of, chance)
        return DriverTraits(
            kind,
            # Who kept less distance than it drives until it reacts could not brake in time.
            self._profile(acceleration, deceleration, max(headway, reaction)),
            exponent,
            speed,
            reaction,
            style.distraction,
            style.horizon,
            style.gives_way,
            style.hesitation,
            within(style.patience, chance[6]),
            signals,
        )

    def _kind(self, chance: float) -> str:
        shares = self.weights
        left = chance * sum(shares.values())
        names = [name for name, share in shares.items() if share > 0]
        for name in names:
            left -= shares[name]
            if left < 0:
                return name
        return names[-1]

    def _profile(self, acceleration: float, deceleration: float, headway: float) -> DriverProfile:
        return DriverProfile(
            acceleration,
            deceleration,
            self.limit,
            self.jam_distance,
            headway,
            self.sight,
            self.politeness,
            self.gain_threshold,
            self.safe_braking,
        )
