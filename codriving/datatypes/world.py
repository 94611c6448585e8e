"""The world at one moment, as it is handed to a method: vehicles, their intents and actions, and where they start."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from math import hypot

from codriving.datatypes.limits import VehicleLimits
from codriving.datatypes.road import LaneId


class Kind(StrEnum):
    """Who drives: a connected automated vehicle or a human."""

    CAV = "CAV"
    HDV = "HDV"


@dataclass(frozen=True, slots=True)
class VehicleState:
    """The physical state of one vehicle, as others near enough could perceive it."""

    id: str  # Name, unique in the episode, for instance ``CAV1``
    kind: Kind
    x: float  # Position of the centre [m]
    y: float  # Position of the centre [m]
    heading: float  # [rad]
    speed: float  # Speed along the heading [m/s]
    acceleration: float  # Commanded acceleration of the last simulation step [m/s2]
    lane: LaneId
    length: float = 5.0  # [m]
    width: float = 2.0  # [m]


@dataclass(frozen=True, slots=True)
class Intent:
    """What a CAV means to do; known to others only if it shares it (CDA class B)."""

    route: str
    target_speed: float  # Speed that the controller tracks [m/s]
    target_lane: LaneId


class Action(StrEnum):
    """A high-level decision that lower-level controllers turn into throttle and steering."""

    SLOWER = "SLOWER"
    IDLE = "IDLE"
    FASTER = "FASTER"
    LANE_LEFT = "LANE_LEFT"
    LANE_RIGHT = "LANE_RIGHT"
    HOLD = "HOLD"  # Keeps the speed that is driven; only where the setting is on


@dataclass(frozen=True, slots=True)
class ControlInput:
    """Pedal and wheel of a CAV until its next decision, in the place of an action."""

    acceleration: float  # [m/s2]
    steering: float  # Angle of the front wheels, positive to the right [rad]


@dataclass(frozen=True, slots=True)
class DrivingModel:
    """The vehicle model seen through the actions (paper Eq. 1)."""

    target_speeds: tuple[float, ...]  # Allowed target speeds, uniformly spaced and rising [m/s]
    speed_gain: float  # Proportional gain K_a of the speed law a = K_a (v_r - v) [1/s]
    step: float  # Simulation step [s]
    decision_interval: float  # Time between two decisions, a multiple of the step [s]
    detection_range: float  # Radius within which a CAV perceives other vehicles [m]
    limits: VehicleLimits | None = None  # What a vehicle can do; None if it can do anything
    human_braking: float = 6.0  # Hardest braking of a human driver [m/s2]
    human_acceleration: float = 1.5  # Hardest acceleration of a human driver [m/s2]; exceeded where there are no limits
    steady: bool = False  # Whether HOLD is an action, and whether CAVs are to avoid reversals, gridlocks and full exits

    @property
    def top_speed(self) -> float:
        """Highest target speed [m/s]."""
        return self.target_speeds[-1]

    def target_after(self, action: Action, speed: float, target: float) -> float | None:
        """Return the target speed after an action at a speed [m/s], None for a lane change.

        FASTER and SLOWER step from the speed that is driven to the next allowed target, HOLD makes it the target, and
        IDLE keeps the target.
        """
        if action in (Action.IDLE, Action.HOLD):
            return target if action is Action.IDLE else speed
        steps = {Action.SLOWER: -1, Action.FASTER: 1}
        if action not in steps:
            return None
        low, top = self.target_speeds[0], len(self.target_speeds) - 1
        nearest = round((speed - low) / (self.target_speeds[-1] - low) * top)
        return self.target_speeds[min(max(min(max(nearest, 0), top) + steps[action], 0), top)]

    @property
    def substeps(self) -> int:
        """Simulation steps per decision."""
        return round(self.decision_interval / self.step)


@dataclass(frozen=True, slots=True)
class Start:
    """The beginning of one vehicle."""

    id: str
    kind: Kind
    route: str
    position: float  # Arc length along the route [m]
    speed: float  # Initial speed [m/s]
    stands: float = 0.0  # How long a human driver stands there before it drives [s]


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything that the seed decides before the first step."""

    seed: int
    starts: tuple[Start, ...]


@dataclass(frozen=True, slots=True)
class Manner:
    """How a human driver treats the right of way; it stands in no world state, since minds cannot be read."""

    gives_way: str  # ``by_rule``, ``to_higher_rank`` or ``never``
    hesitates: bool  # Whether it still waits for all that move, although it may go first
    reaction: float  # Time from what happens to what it does about it [s]
    distraction: float = 0.0  # How much later it sees who crosses its way [s]


@dataclass(frozen=True, slots=True)
class Told:
    """How old, and how exact, what one CAV knows of another vehicle by messages is."""

    age: float  # Age of its state; 0 where the CAV's own sensors see it [s]
    intent_age: float | None  # Age of its intent; None if it is not known [s]
    seen: bool = False  # Whether the CAV's own sensors see it
    behind: float = 0.0  # How far behind the place at which it is taken to be it may be [m]
    ahead: float = 0.0  # How far ahead of it [m]
    aside: float = 0.0  # How far beside it, by the noise of the message alone [m]
    slower: float = 0.0  # How much slower than it is taken to be it may be [m/s]
    faster: float = 0.0  # How much faster [m/s]
    # Where it was, and its heading, when this was so; None if its way since is known [m, m, rad].
    since: tuple[float, float, float] | None = None


@dataclass(frozen=True, slots=True)
class WorldState:
    """All vehicles on the road, and what the CAVs among them intend; or as much of it as one CAV knows.

    Human drivers have no entry in ``intents``: their minds cannot be read. In what one CAV knows another CAV whose
    intent has not reached it counts as a human driver.
    """

    time: float  # Simulated time [s]
    step: int
    vehicles: tuple[VehicleState, ...]
    intents: Mapping[str, Intent]
    available: Mapping[str, tuple[Action, ...]]
    signals: Mapping[str, str] = field(
        default_factory=dict
    )  # ``left`` or ``right`` of each vehicle that signals a turn
    hidden: tuple[tuple[str, str], ...] = ()  # Pairs between which a building stands, in the order of names
    viewer: str | None = None  # The CAV, or the unit, whose knowledge this is; None for the world as it is
    told: Mapping[str, Told] = field(default_factory=dict)  # What the viewer knows by messages, by id of the vehicle
    routes: Mapping[str, str] = field(default_factory=dict)  # Routes that human drivers have told the viewer, by id

    @property
    def cavs(self) -> tuple[VehicleState, ...]:
        """The connected automated vehicles on the road."""
        return tuple(v for v in self.vehicles if v.kind is Kind.CAV)

    @property
    def hdvs(self) -> tuple[VehicleState, ...]:
        """The human-driven vehicles on the road."""
        return tuple(v for v in self.vehicles if v.kind is Kind.HDV)

    def senses(self, one: VehicleState, other: VehicleState, reach: float) -> bool:
        """Whether a vehicle is within reach [m] of the sensors of another one, and no building between them."""
        if one.id == self.viewer and (told := self.told.get(other.id)) is not None:
            return told.seen
        near = hypot(one.x - other.x, one.y - other.y) <= reach
        return near and (min(one.id, other.id), max(one.id, other.id)) not in self.hidden

    def known_to_cavs(self, vehicle: VehicleState, reach: float) -> bool:
        """Whether the CAVs know of a vehicle if they share what their sensors see within a reach [m]."""
        return vehicle.id in self.told or any(self.senses(cav, vehicle, reach) for cav in self.cavs)

    def way_of(self, name: str, speed: float) -> Intent | None:
        """Return the route that a human driver has told, as an intent to keep its speed [m/s]; None if it has not."""
        return Intent(self.routes[name], speed, ("", "", 0)) if name in self.routes else None

    @property
    def deciding(self) -> tuple[str, ...]:
        """The CAVs that are decided for: all, or the one whose knowledge this is; none if it is that of no CAV."""
        return tuple(cav.id for cav in self.cavs if self.viewer in (None, cav.id))
