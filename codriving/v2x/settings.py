"""The settings of a channel; with ``v2x=perfect`` there is none, and no message is sent at all."""

from dataclasses import dataclass
from typing import Literal

from codriving.errors import require, require_range

NONE = "none"  # Each CAV computes the order by itself, and no message carries one


@dataclass(frozen=True, slots=True)
class OrderSettings:
    """How CAVs agree on who goes first.

    Raises:
        ConfigError: If a value is out of its range, or an emergency vehicle is named without one who coordinates.
    """

    by: Literal["road_side_unit", "fleet", "cav", "distributed", "none"]  # Who coordinates
    rounds: int  # Proposals that are made at most before one negotiation ends
    validity: float  # How long a proposal and an agreement hold [s]
    emergency: str | None  # The CAV that is let through first
    order_bytes: int  # Size of a message about an order, without its pairs
    pair_bytes: int  # Size of one pair

    def __post_init__(self) -> None:
        require_range("rounds", self.rounds, 1, 100)
        require_range("validity", self.validity, 0.1, 60, " s")
        for key in ("order_bytes", "pair_bytes"):
            require_range(key, getattr(self, key), 0, 100_000)
        require(
            self.emergency is None or self.by != NONE,
            "emergency takes one who coordinates; set by=road_side_unit, fleet, cav or distributed",
        )


@dataclass(frozen=True, slots=True)
class ChannelSettings:
    """How messages reach other CAVs: how often, how late, how far and how surely.

    Raises:
        ConfigError: If a value is out of its range.
    """

    rate: float  # Messages of each kind that a CAV sends a second [Hz]
    age: float  # Mean time from making a message to its arrival [s]
    age_shape: float  # Shape of the Gamma distribution of that time; 0 for always the same
    loss: float  # Share of messages that are lost
    burst: float  # Mean number of messages lost in a row (Gilbert-Elliott), at least as many as without any memory
    range: float  # Distance up to which a message is received [m]
    noise: float  # Standard deviation of positions in messages, each coordinate, cut off at three times that [m]
    speed_noise: float  # The same for speeds [m/s]
    validity: float  # How long a message may be used [s]
    cam_bytes: int  # Size of a message about one's own state
    cpm_bytes: int  # Size of a message about vehicles that are seen, without these
    object_bytes: int  # Size of one such vehicle
    mcm_bytes: int  # Size of a message about an intent
    telling_humans: float = 0.0  # Share of human drivers who tell their state and their route
    coordination: OrderSettings | None = None  # How orders are agreed on; None if each CAV computes them by itself

    def __str__(self) -> str:
        """Say how messages are, in a few words."""
        spread = "Gamma" if self.age_shape > 0 and self.age > 0 else "always"
        late = f"{self.age:g} s late ({spread})" if self.age > 0 else "at once"
        lost = f"{100 * self.loss:g} % lost"
        return (
            f"{self.rate:g} Hz, {late}, {lost}, {self.range:g} m far, noise {self.noise:g} m, {self.speed_noise:g} m/s"
        )

    def __post_init__(self) -> None:
        require_range("rate", self.rate, 0.5, 100, " Hz")
        for key, value, most, unit in (
            ("age", self.age, 10, " s"),
            ("age_shape", self.age_shape, 100, ""),
            ("loss", self.loss, 0.99, ""),
            ("range", self.range, 10_000, " m"),
            ("noise", self.noise, 10, " m"),
            ("speed_noise", self.speed_noise, 10, " m/s"),
            ("validity", self.validity, 60, " s"),
        ):
            require_range(key, value, 0, most, unit)
        require_range("burst", self.burst, 1, 1000)
        require_range("telling_humans", self.telling_humans, 0, 1)
        for key in ("cam_bytes", "cpm_bytes", "object_bytes", "mcm_bytes"):
            require_range(key, getattr(self, key), 0, 100_000)
