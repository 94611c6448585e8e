"""Episodes as CAVs that learn go through them: observations, actions, rewards and endings."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from codriving.datatypes import Action, ControlInput, Ending, Kind, WorldState
from codriving.environment import Environment
from codriving.errors import EpisodeError, ScenarioError
from codriving.gym.actions import ActionType, SemanticActions
from codriving.gym.observation import FloatArray, Observer
from codriving.gym.reward import CavStep, RewardWeights, rewards

Info = dict[str, Any]


class StepResult(NamedTuple):
    """What one decision step brought each CAV that was on the road, by id."""

    rewards: dict[str, float]
    terminated: dict[str, bool]
    truncated: dict[str, bool]


class AgentEpisode:
    """Drives the environment by actions as numbers, and gives observations and rewards.

    Attributes:
        world: The world as it is now; None before the first episode.
    """

    def __init__(
        self, environment: Environment, observer: Observer, weights: RewardWeights, kind: ActionType | None = None
    ) -> None:
        self.environment, self.observer, self.weights = environment, observer, weights
        self.cavs = [start.id for start in environment.scenario.scene(0).starts if start.kind is Kind.CAV]
        self.kind = kind or SemanticActions(environment.driving_model)
        self.driving: list[str] = []
        self.world: WorldState | None = None
        self.actions: dict[str, Action | ControlInput] = {}
        self.seed = 0
        self._refused: dict[str, int] = {}
        self._views: dict[str, FloatArray] = {}

    def begin(self, seed: int) -> None:
        """Begin an episode."""
        self.world, self.driving, self.actions = None, [], {}
        world = self.environment.reset(seed)
        if sorted(world.available) != sorted(self.cavs):
            raise ScenarioError(
                f"{self.environment.scenario.name} must have the same CAVs for every seed, since agents and spaces are "
                f"fixed; it has {', '.join(self.cavs)} with seed 0 and {', '.join(world.available)} with seed {seed}"
            )
        self.world, self.driving, self.seed = world, list(self.cavs), seed
        self._refused, self._views = dict.fromkeys(self.cavs, 0), self.observer.observe(world)

    def step(self, actions: Mapping[str, object]) -> StepResult:
        """Carry out one decision of every CAV on the road."""
        before = self.world
        if before is None or not self.driving:
            raise EpisodeError("no episode is going on; call reset() before step(actions)")
        driving = self.driving
        self.actions = self._decide(actions, before)
        world = self.world = self.environment.step(self.actions)
        self._views = self.observer.observe(world)
        on_road = [name for name in driving if name in world.available]
        outcome = self.environment.outcome
        late = on_road if outcome is not None and outcome.ending is Ending.TIMEOUT else []
        self.driving = on_road if outcome is None else []
        return StepResult(
            rewards=dict(zip(driving, self._rewards(before, world), strict=True)),
            terminated={name: name not in self.driving and name not in late for name in driving},
            truncated={name: name in late for name in driving},
        )

    def observations(self, names: Sequence[str]) -> dict[str, FloatArray]:
        """Return what CAVs observe now; zeros for those that have left the road."""
        views = self._views
        return {name: views[name].copy() if name in views else self.observer.nothing() for name in names}

    def info(self, name: str) -> Info:
        """Return what is to be said of a CAV besides."""
        assert self.world is not None
        outcome = self.environment.outcome
        involved = () if outcome is None else outcome.failed
        return {
            **self.kind.said(self.world.available.get(name, ())),
            "refused": self._refused[name],
            "arrived": name not in self.world.available,
            "outcome": "" if outcome is None else str(outcome.ending),
            "crashed": name in involved,
            "involved": involved,
            "seed": self.seed,
        }

    def _decide(self, actions: Mapping[str, object], world: WorldState) -> dict[str, Action | ControlInput]:
        """Return what each CAV carries out: IDLE instead of what the road does not allow, as in highway-env."""
        missing = [name for name in self.driving if name not in actions]
        unknown = [str(name) for name in actions if name not in self.cavs]
        if missing or unknown:
            fault = f"none for {', '.join(missing)}" if missing else f"one for {', '.join(unknown)}"
            raise EpisodeError(f"one action for each of {', '.join(self.driving)} is needed, got {fault}")
        wanted = {name: self.kind.read(name, actions[name]) for name in self.driving}
        for name, action in wanted.items():
            if isinstance(action, Action) and action not in world.available[name]:
                wanted[name] = Action.IDLE
                self._refused[name] += 1
        return wanted

    def _rewards(self, before: WorldState, after: WorldState) -> list[float]:
        """Return the reward of each CAV that decided, in the same order."""
        outcome = self.environment.outcome
        failed = () if outcome is None else outcome.failed
        then, now = ({v.id: v for v in world.cavs} for world in (before, after))
        driven = [CavStep(then[name], now.get(name), done, name in failed) for name, done in self.actions.items()]
        return rewards(self.weights, driven, after.time - before.time, self.environment.driving_model.target_speeds[-1])
