"""The parts that a run is put together from, as base classes: what is built from a config is one of these."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from codriving.datatypes.cooperation import Coordination, Party
from codriving.datatypes.experience import Experience, Interaction, Memory
from codriving.datatypes.judgement import MetDriver
from codriving.datatypes.record import Outcome, Score, Trajectory
from codriving.datatypes.road import Road, Route
from codriving.datatypes.situation import Deliberation, Situation
from codriving.datatypes.world import Action, DrivingModel, Kind, Manner, Scene, Start, WorldState

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

# The precomputed road, of which this room may not know: ``codriving.geometry.road_map.RoadMap``.
RoadMap: TypeAlias = Any

Pace: TypeAlias = Any  # The settings that all scenarios share, likewise: ``codriving.scenarios.Pace``

Chat: TypeAlias = Any  # The client of a language model, likewise: ``codriving.llm.question.Chat``

# Counters by column, and lines of ``transcript.jsonl``.
Account: TypeAlias = tuple[dict[str, float], list[dict[str, Any]]]


class Scenario(ABC):
    """A road, the vehicles that a seed puts on it, and the pace of the simulation."""

    name: str = ""  # Name in tables and folders
    pace: Pace  # Frequencies, target speeds, time limit and perception

    @property
    @abstractmethod
    def road(self) -> Road:
        """The road; the same object for every seed."""

    @abstractmethod
    def scene(self, seed: int) -> Scene:
        """Draw where each vehicle starts, how fast, and with which destination.

        Raises:
            ScenarioError: If the vehicles cannot be placed.
        """

    @property
    def ways(self) -> tuple[Route, ...]:
        """The routes that vehicles are drawn on."""
        return self.road.routes

    @property
    def without_flows(self) -> str:
        """Why it takes no flows; empty if it does."""
        return "" if type(self).arrival is not Scenario.arrival else "its class has no method arrival()"

    def arrival(self, rng: "np.random.Generator", name: str, kind: Kind, route: str) -> Start:
        """Draw how a vehicle of a flow comes in at the beginning of a route."""
        raise NotImplementedError(self.without_flows)


class Drivers:
    """What ``drivers=`` chooses: how human drivers drive."""


class Simulator(ABC):
    """A world that takes actions, from a seed to an outcome."""

    road_map: RoadMap
    driving_model: DrivingModel  # How a CAV answers to actions
    # Is shown the world at each simulation step, with the routes of human drivers, some of whom may tell them.
    observer: "Callable[[WorldState], None] | None" = None

    @property
    @abstractmethod
    def outcome(self) -> Outcome | None:
        """How the episode ended; None while it goes on."""

    @abstractmethod
    def reset(self, seed: int) -> WorldState:
        """Begin the episode of a seed."""

    def hand_over(self) -> WorldState:
        """Let all CAVs of the episode that has just begun drive as human drivers do; they then take no actions."""
        raise NotImplementedError(f"{type(self).__name__} has no drivers to whom CAVs could be handed over")

    @abstractmethod
    def step(self, actions: Mapping[str, Action]) -> WorldState:
        """Drive until the next decision."""

    @abstractmethod
    def trajectory(self) -> Trajectory:
        """Return what was driven since the last reset."""

    def manners(self) -> Mapping[str, Manner]:
        """Return how each human driver on the road treats the right of way, by id; nothing where that is not known."""
        return {}

    def alone(self, seed: int) -> "Mapping[str, NDArray[np.float64]]":
        """Drive each vehicle of an episode alone, from the same start along the same route.

        Returns:
            Its arc length along the route at each step (n,) [m], by id; nothing of what cannot be driven alone.
        """
        return {}


class Model(ABC):
    """What ``llm=`` chooses; a method that has a parameter with this annotation is handed it."""

    name: str  # Name in tables
    max_concurrency: int  # Most episodes that are worth driving at once
    failures_in_a_row: int  # The batch stops after so many episodes without an answer
    cache: str  # ``off``, ``use`` or ``replay``
    ask_plain: bool  # Whether it is asked even where no other vehicle is near and the best action is plain
    prompts: str | None  # Set of prompts, or folder with templates that replace them; None takes the first set
    thoughts: bool = False  # Whether it writes its thoughts down before it answers
    latency: str | float = "none"  # How long a question takes in the world: ``none``, ``measured`` or a time [s]
    waits: bool = True  # Whether a server answers, for which episodes wait in threads of one process

    @abstractmethod
    def chat(self) -> Chat | None:
        """Return the client, one for all methods with the same settings; None for the built-in rules."""

    def files(self) -> Mapping[str, Path]:
        """Name the files, by what they are, on whose content its answers depend, beside the templates."""
        return {}


class RuleModel(Model):
    """The built-in rules: no network, no key, deterministic."""

    name = "rules"
    max_concurrency = 1
    failures_in_a_row = 1
    cache = "off"
    ask_plain = False
    prompts = None

    def chat(self) -> None:
        """Return nothing: there is no model to ask."""


class CaseMemory(ABC):
    """What ``memory=`` chooses; a method that has a parameter with this annotation is handed it."""

    label: str = ""  # What it is called in tables
    digest: str = ""  # SHA-256 of the contents of a snapshot; empty where there is none
    asks: bool = False  # Whether a server is asked to find what is similar
    learns: bool = False  # Whether episodes learn from one another, so that they have to be driven in order
    reflections: int = 0  # Mistakes of an episode whose lessons a language model writes at most

    def prepare(self) -> None:
        """Refuse, before the first episode and with a ``UserError``, what would fail in each of them."""
        return None

    def begin(self, interaction: Interaction) -> None:
        """Begin an episode: what is learnt from now on is learnt in it."""
        return None

    @abstractmethod
    def recall(self, situations: Sequence[Situation]) -> list[tuple[Memory, ...]]:
        """Find experiences similar to each situation, most similar first."""

    def encounters(self) -> Sequence[MetDriver]:
        """Return what human drivers did who were met before."""
        return ()

    def learn(self, experiences: Sequence[Experience], encounters: Sequence[MetDriver] = ()) -> int:
        """Keep what was learnt in the episode that has begun; gives how many of the experiences are new."""
        return 0


@dataclass(frozen=True, slots=True)
class Shares:
    """What the CAVs of a method tell one another."""

    states: bool = False  # Their states, and the vehicles that they see (class A of SAE J3216)
    intents: bool = False  # Their routes and target speeds (class B)
    orders: bool = False  # Who goes first (class C)


class Method(ABC):
    """Decides for all CAVs, one decision step after another.

    A method that needs a language model or a memory has a parameter of its constructor annotated with ``Model`` or
    ``CaseMemory``, and is handed what ``llm=`` and ``memory=`` choose.
    """

    name: str = ""  # Name in tables
    variant: str = ""  # Its variant in tables; empty if there is only one
    reasoner: str = "none"  # What reasons: ``rules``, the name of a language model, or ``none``
    remembers: str = ""  # Its memory in tables; empty without one
    most_cavs: int | None = None  # CAVs on the road that it can decide for at most; None for any number
    is_checked: bool = False  # Whether its actions pass the safety check of codriving already
    hands_over: bool = False  # Whether its CAVs drive as human drivers do, so that it gives no actions
    knows_drivers: bool = False  # Whether it is told what no vehicle can know: how human drivers treat the right of way
    shares: Shares = Shares()
    coordination: Coordination | None = None  # How its one CAV agrees with others by messages; None if it does not
    party: Party | None = None  # What does so for it; only from ``reset`` on
    observer: "Callable[[WorldState], None] | None" = None  # Wants to be shown the world at each simulation step

    def check_road(self, road: Road, target_speeds: Sequence[float], decision_interval: float) -> None:
        """Refuse a road that the method was not made for, before anything is driven.

        Args:
            target_speeds: Speeds that FASTER and SLOWER step through [m/s].
            decision_interval: Time between two decisions [s].

        Raises:
            UserError: With the reason.
        """
        return None

    def files(self, road: Road, limited: bool) -> Mapping[str, Path]:
        """Return the files whose content decides what is driven on a road, by what they are.

        A run whose files have changed does not go on in its folder.

        Args:
            limited: Whether vehicles have limits.
        """
        return {}

    def remark(self, road: Road, world: Mapping[str, str]) -> str:
        """Return what a reader of its numbers has to know, in one line; empty if it is nothing.

        Args:
            world: Names of the ``limits`` and ``drivers`` with which it drives.
        """
        return ""

    @abstractmethod
    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode; nothing of the one before is left.

        Args:
            seed: For what the method draws at random. It is not the seed of the episode, from which the scene with the
                routes of human drivers could be made again.
        """

    def cooperate(self, coordination: Coordination) -> None:
        """Agree with others on orders by messages, from the next ``reset`` on; only if it shares orders.

        Raises:
            ConfigError: If it cannot be coordinated so.
        """
        self.coordination = coordination

    def be_told(self, manners: Mapping[str, Manner]) -> None:
        """Hear how human drivers treat the right of way, before each decision; only if ``knows_drivers``."""
        return None

    @abstractmethod
    def act(self, world: WorldState) -> Deliberation:
        """Decide for every CAV on the road."""

    def ask_once(self, world: WorldState) -> Deliberation:
        """Decide as ``act`` does, with as few questions to a language model as show each kind of them."""
        return self.act(world)

    def conclude(self, world: WorldState, outcome: Outcome) -> Account:
        """Learn from an episode that has come to its end."""
        return {}, []

    @property
    def misbehaving(self) -> Mapping[str, str]:
        """How each CAV of the episode misbehaves that does, by id; it stands in the record and reaches no decision."""
        return {}

    def unfinished_step(self, time: float) -> Account:
        """Return what was asked in a step that an error broke off at a time [s], so that its cost is not lost."""
        return {}, []


class Wrapped(Method):
    """A method around another one, which answers for it wherever nothing else is said."""

    def __init__(self, method: Method) -> None:
        self.method = method
        self.name, self.variant, self.reasoner = method.name, method.variant, method.reasoner
        self.remembers, self.most_cavs, self.is_checked = method.remembers, method.most_cavs, method.is_checked
        self.hands_over, self.knows_drivers, self.shares = method.hands_over, method.knows_drivers, method.shares
        self.observer = method.observer

    def check_road(self, road: Road, target_speeds: Sequence[float], decision_interval: float) -> None:
        self.method.check_road(road, target_speeds, decision_interval)

    def files(self, road: Road, limited: bool) -> Mapping[str, Path]:
        return self.method.files(road, limited)

    def remark(self, road: Road, world: Mapping[str, str]) -> str:
        return self.method.remark(road, world)

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        self.method.reset(road_map, model, seed)
        self.party = self.method.party

    def cooperate(self, coordination: Coordination) -> None:
        self.method.cooperate(coordination)

    def be_told(self, manners: Mapping[str, Manner]) -> None:
        self.method.be_told(manners)

    def conclude(self, world: WorldState, outcome: Outcome) -> Account:
        return self.method.conclude(world, outcome)

    @property
    def misbehaving(self) -> Mapping[str, str]:
        return self.method.misbehaving

    def unfinished_step(self, time: float) -> Account:
        return self.method.unfinished_step(time)


class Cooperation:
    """How far CAVs cooperate: base of what a choice of ``cda`` may be; it has no hooks."""

    __slots__ = ()


class OrderExecutor:
    """What turns orders into actions: base of what a choice of ``executor`` may be; reasoning adds its hooks."""


class OrderOfCavs:
    """What says who passes first: base of what a choice of ``order`` may be; reasoning adds its hooks."""

    most_cavs: int | None = None  # CAVs that it orders at most; None for any number


class HumanJudge:
    """What says of human drivers whether they let a CAV pass: base of what a choice of ``judgement`` may be."""


class ActionFilter:
    """What all actions of a method pass: base of what a choice of ``filter`` may be."""

    def around(self, method: Method) -> Method:
        """Return the method with all its actions filtered; the method itself if none can be."""
        return method


class Communication:
    """How CAVs hear of one another: base of what a choice of ``v2x`` may be."""

    def between(self, method: Method, shared: Sequence[object]) -> Method:
        """Return the method with a copy for each CAV, which knows what has reached that one.

        Args:
            shared: What all copies use together, for instance the language model.
        """
        return method

    def notes(self, method: Method, brief: bool) -> tuple[str, ...]:
        """Say what it means for a method that ``between`` has returned, ``{}`` standing for names of such methods.

        Args:
            brief: Whether the settings are told elsewhere.
        """
        return ()


class ThinkingTime:
    """What lets time pass while a method thinks: base of what ``thinking`` may be."""

    def around(self, method: Method, llm: Model | None) -> Method:
        """Return the method with its answers as late as its thinking takes; the method itself if it takes none."""
        return method

    def notes(self, method: Method) -> tuple[str, ...]:
        """Say what it means for a method that ``around`` has returned, ``{}`` standing for names of such methods."""
        return ()


class EpisodeLauncher:
    """Where episodes are driven: base of what a choice of ``launcher`` may be; a batch adds its hooks."""


class Metric(ABC):
    """Scores one driven episode."""

    name: str = ""  # Name of the definitions, for instance ``standard``
    against_alone: bool = False  # Whether it needs ``Trajectory.alone``, which costs computing time
    flows: bool = False  # Whether it measures flows, too, whose ``Outcome.flow`` is not None

    @abstractmethod
    def score(self, trajectory: Trajectory, outcome: Outcome, road: RoadMap) -> Score:
        """Return the score of an episode."""

    def score_recording(self, trajectory: Trajectory, outcome: Outcome) -> Score | None:
        """Return the score of trajectories of whose road nothing is known; None if it takes a road."""
        return None
