"""What the loop needs of an environment, a method and a metric; anything with this shape will do."""

from collections.abc import Mapping
from typing import Any, Protocol, TypeAlias

from codriving.datatypes.action import Action
from codriving.datatypes.driving_model import DrivingModel
from codriving.datatypes.outcome import Outcome
from codriving.datatypes.score import Score
from codriving.datatypes.trajectory import Trajectory
from codriving.datatypes.world import WorldState

RoadMap: TypeAlias = Any
"""The precomputed road (``codriving.geometry``); the loop only hands it from the one to the other."""


class Deliberation(Protocol):
    """What a method made of one moment."""

    @property
    def actions(self) -> Mapping[str, Action]:
        """Action of each CAV, by id."""
        ...

    @property
    def counts(self) -> Mapping[str, int | float]:
        """Counters of this step (fallbacks, repaired orders, cost, ...), summed over the episode."""
        ...

    def as_dict(self) -> dict[str, Any]:
        """Give the line of ``decisions.jsonl``."""
        ...


class Environment(Protocol):
    """A world that takes actions, from a seed to an outcome."""

    @property
    def road_map(self) -> RoadMap:
        """The road with everything precomputed."""
        ...

    @property
    def driving_model(self) -> DrivingModel:
        """How a CAV answers to actions."""
        ...

    @property
    def outcome(self) -> Outcome | None:
        """How the episode ended; None while it goes on."""
        ...

    def reset(self, seed: int) -> WorldState:
        """Begin the episode of a seed."""
        ...

    def step(self, actions: Mapping[str, Action]) -> WorldState:
        """Drive until the next decision."""
        ...

    def trajectory(self) -> Trajectory:
        """Give what was driven since the last reset."""
        ...


class Method(Protocol):
    """Who decides for all CAVs.

    A method that asks a language model may also have ``unfinished_step(time)``: it gives counters and lines of the
    transcript of a step that an error has broken off.
    """

    @property
    def name(self) -> str:
        """Name of the method in tables."""
        ...

    @property
    def variant(self) -> str:
        """Name of the CDA variant in tables."""
        ...

    @property
    def reasoner(self) -> str:
        """Who reasons: ``rules`` or the name of a model."""
        ...

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Forget the last episode and prepare for the next."""
        ...

    def act(self, world: WorldState) -> Deliberation:
        """Decide for every CAV on the road."""
        ...


class Metrics(Protocol):
    """What an episode is judged by."""

    @property
    def name(self) -> str:
        """Name of the definitions, for instance ``standard``."""
        ...

    def score(self, trajectory: Trajectory, outcome: Outcome, road: RoadMap) -> Score:
        """Judge one episode."""
        ...
