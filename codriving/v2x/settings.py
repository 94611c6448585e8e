"""The settings of a channel; with ``v2x=perfect`` there is none, and no message is sent at all."""

from dataclasses import dataclass, fields
from re import fullmatch
from typing import Literal

from codriving.errors import require, require_range

NONE = "none"  # Each CAV computes the order by itself, and no message carries one


@dataclass(frozen=True, slots=True)
class OrderSettings:
    """How CAVs agree on who goes first.

    Raises:
        ConfigError: If a value is out of its range, or an emergency vehicle is no CAV or no party coordinates.
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
            self.emergency is None or fullmatch(r"CAV[1-9]\d*", self.emergency) is not None,
            f"emergency must be the name of a CAV, for instance CAV1, or null, got {self.emergency}",
        )
        require(
            self.emergency is None or self.by != NONE,
            "emergency takes one who coordinates; set by=road_side_unit, fleet, cav or distributed",
        )


@dataclass(frozen=True, slots=True)
class Misbehaviour:
    """Shares of CAVs that misbehave, a kind each; a CAV does so in one way at most.

    Raises:
        ConfigError: If a value is out of its range, or the shares add up to more than 1.
    """

    lies_position: float  # Tell a false position
    lies_intent: float  # Tell another route and target speed than theirs
    ghost: float  # Tell of vehicles that are not there
    does_not_yield: float  # Agree to an order, and drive as if they went first
    never_answers: float  # Tell their state, but no intent, and take no part in orders
    along: float  # How far ahead of or behind the true position a false one is [m]
    across: float  # How far beside it [m]

    def __post_init__(self) -> None:
        for kind, share in self.shares.items():
            require_range(kind, share, 0, 1)
        total = sum(self.shares.values())
        names = ", ".join(self.shares)
        require(total <= 1 + 1e-9, f"{names} must add up to at most 1, since a CAV is of one kind, got {total:g}")
        require_range("along", self.along, 0, 200, " m")
        require_range("across", self.across, 0, 50, " m")

    @property
    def shares(self) -> dict[str, float]:
        """The share of each kind."""
        return {field.name: getattr(self, field.name) for field in fields(self)[:5]}


HONEST = Misbehaviour(0.0, 0.0, 0.0, 0.0, 0.0, along=15.0, across=3.5)


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
    misbehaviour: Misbehaviour = HONEST
    plausibility: bool = False  # Whether what a message says is compared with what the receiver's sensors see
    distrust: float = 5.0  # How long a sender is not believed whose message does not agree with that [s]
    place_tolerance: float = 1.0  # How much farther than age and noise explain a place may be wrong [m]
    route_tolerance: float = 2.5  # How far beside the route that it tells a vehicle may drive [m]
    speed_tolerance: float = 0.5  # How much harder it may accelerate than its target speed asks for [m/s2]
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
            ("distrust", self.distrust, 600, " s"),
            ("place_tolerance", self.place_tolerance, 50, " m"),
            ("route_tolerance", self.route_tolerance, 20, " m"),
            ("speed_tolerance", self.speed_tolerance, 20, " m/s2"),
        ):
            require_range(key, value, 0, most, unit)
        require_range("burst", self.burst, 1, 1000)
        require_range("telling_humans", self.telling_humans, 0, 1)
        for key in ("cam_bytes", "cpm_bytes", "object_bytes", "mcm_bytes"):
            require_range(key, getattr(self, key), 0, 100_000)
