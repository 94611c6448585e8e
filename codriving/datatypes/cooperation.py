"""What CAVs and a coordinator say to one another about who goes first (classes C and D of SAE J3216)."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from codriving.datatypes.order import Precedence

NEAREST, EACH = "cav", "distributed"  # Who coordinates, if it is one of the CAVs, and if each does so for itself

UNITS = {"RSU": "a road side unit", "fleet": "the centre of a fleet"}  # Who else may, by name, and its authority


@dataclass(frozen=True, slots=True)
class Coordination:
    """How one party agrees with the others on who goes first."""

    party: str  # Its own name
    by: str  # Who coordinates: the name of a party, ``cav`` or ``distributed``
    rounds: int  # Proposals that are made at most before one negotiation ends
    validity: float  # How long a proposal and an agreement hold [s]
    centre: tuple[float, float]  # The middle of the junction [m]
    emergency: str = ""  # The CAV that is let through first
    authority: str = ""  # By what a coordinator of class D directs


@dataclass(frozen=True, slots=True)
class OrderMessage:
    """What one party tells others about an order."""

    sender: str
    time: float  # When it was made [s]
    number: int  # Of the proposal, counted by the one that makes it
    round: int
    pairs: tuple[Precedence, ...]  # Pairs of CAVs, each with the reason


@dataclass(frozen=True, slots=True)
class Proposal(OrderMessage):
    """An order that is put forward."""

    to: tuple[str, ...]  # Whose answer is wanted
    humans: tuple[str, ...]  # The human drivers that it takes into account
    validity: float  # [s]


@dataclass(frozen=True, slots=True)
class Response(OrderMessage):
    """The answer of one CAV; if it rejects a proposal its pairs say what has to be instead, and why."""

    to: str
    accepted: bool


@dataclass(frozen=True, slots=True)
class OrderAgreement(OrderMessage):
    """The pairs that both have accepted; or, with an authority, an instruction to all who receive it."""

    validity: float  # [s]
    authority: str = ""  # By what it directs; empty if it was agreed on

    def holds(self, time: float) -> bool:
        """Whether it is in force at a time [s]."""
        return time <= self.time + self.validity + 1e-9


class Party(ABC):
    """One that takes part in negotiations: what it hears and says between two decisions, and what it holds."""

    @abstractmethod
    def hear(self, messages: Sequence[OrderMessage], time: float) -> None:
        """Take in what has arrived, and answer it by what was known at the last decision."""

    @abstractmethod
    def speak(self) -> list[OrderMessage]:
        """Return what it wants to send since it was asked last."""

    @property
    @abstractmethod
    def held(self) -> Mapping[str, OrderAgreement]:
        """The agreements in force at the last decision, by sender."""
