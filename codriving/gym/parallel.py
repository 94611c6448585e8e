"""Every CAV an agent: our environment as a PettingZoo `ParallelEnv`."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from gymnasium.spaces import Box, Discrete
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from codriving.animation import LivePicture
from codriving.datatypes import Action, WorldState
from codriving.errors import ConfigError, EpisodeError
from codriving.gym.actions import action_type, check_seed, draw_seed
from codriving.gym.configured import configured
from codriving.gym.episode import AgentEpisode, Info, StepResult
from codriving.gym.observation import CdaObserver, FloatArray, Layout
from codriving.gym.reward import RewardWeights, reward_weights

RENDER_MODES = ("rgb_array",)
METADATA: dict[str, Any] = {"render_modes": list(RENDER_MODES), "is_parallelizable": True}

Infos = dict[str, Info]
Observations = dict[str, FloatArray]


class ParallelDriving(ParallelEnv):
    """Several CAVs among human drivers; all decide at once.

    Args:
        name: Name of the scenario, for instance ``roundabout``.
        *overrides: ``key=value`` tokens that begin with ``scenario``, ``environment``, ``suite``, ``limits``,
            ``drivers``, ``cda`` or ``plugins``.
        cda: How far the CAVs cooperate, which decides what they observe; a preset such as ``status_sharing``.
        coordinates: ``relative`` or ``absolute`` places of the other vehicles.
        render_mode: ``rgb_array``, or None for no pictures.
        actions: ``semantic``, or ``continuous`` for acceleration and steering.
        **settings: Keys of the scenario, for instance ``cavs=4``.

    Raises:
        ConfigError: If a setting cannot be used.
    """

    metadata = METADATA

    def __init__(
        self,
        name: str,
        *overrides: str,
        cda: str = "full",
        rows: int = 8,
        coordinates: str = "relative",
        normalise: bool = False,
        reward: RewardWeights | Mapping[str, float] | None = None,
        render_mode: str | None = None,
        config_dir: str | Path | None = None,
        actions: str = "semantic",
        **settings: Any,  # noqa: ANN401 - whatever the scenario's keys take
    ) -> None:
        if render_mode is not None and render_mode not in RENDER_MODES:
            raise ConfigError(f"render_mode must be {' or '.join(RENDER_MODES)} or None, got {render_mode!r}")
        layout, weights = Layout(rows, coordinates, normalise), reward_weights(reward)
        self.environment, level = configured(name, overrides, cda, config_dir, settings)
        model = self.environment.driving_model
        observer = CdaObserver(self.environment.road_map, model, level, layout)
        self._drive = AgentEpisode(self.environment, observer, weights, action_type(actions, model))
        self.name, self.render_mode, self.lanes = name, render_mode, observer.lanes
        version = 0 if [token for token in overrides if token.startswith("suite=")][-1:] == ["suite=paper"] else 1
        self.metadata = {**METADATA, "name": f"codriving_{name}_v{version}", "render_fps": 1 / model.decision_interval}
        self.possible_agents = list(self._drive.cavs)
        self.observation_spaces = {agent: observer.space() for agent in self.possible_agents}
        self.action_spaces = {agent: self._drive.kind.space() for agent in self.possible_agents}
        spaces = self.observation_spaces.values()
        self.state_space = Box(np.stack([s.low for s in spaces]), np.stack([s.high for s in spaces]), dtype=np.float32)
        self._rng: np.random.Generator | None = None
        self._picture: LivePicture | None = None

    @property
    def agents(self) -> list[str]:
        """Ids of the CAVs on the road while an episode goes on."""
        return list(self._drive.driving)

    @property
    def world(self) -> WorldState:
        """The world as it is now, as a method is handed it.

        Raises:
            EpisodeError: If no episode has begun.
        """
        if self._drive.world is None:
            raise EpisodeError("no episode has begun; call reset() first")
        return self._drive.world

    def observation_space(self, agent: str) -> Box:
        """Return the space of an agent's observations."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> Discrete | Box:
        """Return the space of an agent's actions."""
        return self.action_spaces[agent]

    def reset(self, seed: int | None = None, options: Mapping[str, Any] | None = None) -> tuple[Observations, Infos]:
        """Begin an episode.

        Args:
            seed: Begins exactly the episode that `codriving run` drives with this seed, and seeds the generator from
                which later episodes are drawn; None draws one.

        Returns:
            Observations and infos by agent.

        Raises:
            EpisodeError: If the seed is not a whole number of at least 0.
            ScenarioError: If the vehicles cannot be placed.
        """
        given = None if seed is None else check_seed(seed)
        if given is not None or self._rng is None:
            self._rng = np.random.default_rng(given)
        self._drive.begin(draw_seed(self._rng) if given is None else given)
        return self._drive.observations(self.possible_agents), self.infos(self.possible_agents)

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[Observations, dict[str, float], dict[str, bool], dict[str, bool], Infos]:
        """Carry out one decision of every CAV on the road.

        Args:
            actions: A number of ``ACTIONS``, or the action itself, for each of ``agents``; those of agents that have
                left are ignored. One that the road does not allow is carried out as IDLE and counted. With
                ``actions="continuous"`` acceleration and steering, each from -1 to 1.

        Returns:
            Observations, rewards, terminations, truncations and infos of all CAVs that were on the road.

        Raises:
            EpisodeError: If no episode is going on, or an action is missing, unknown, or of no CAV.
        """
        driving, result = self.agents, self.advance(actions)
        return self._drive.observations(driving), *result, self.infos(driving)

    def advance(self, actions: Mapping[str, Any]) -> StepResult:
        """Do what `step` does, without observations and infos."""
        return self._drive.step(actions)

    def state(self) -> FloatArray:
        """Return the observations of all CAVs in the order of ``possible_agents``; zeros for those that have left.

        Returns:
            The joint observation (cavs, rows, 6), which lies in ``state_space``.

        Raises:
            EpisodeError: If no episode has begun.
        """
        assert self.world
        return np.stack(list(self._drive.observations(self.possible_agents).values()))

    def render(self) -> NDArray[np.uint8] | None:
        """Draw the world as it is now.

        Returns:
            A picture (height, width, 3), RGB; None without a render mode.

        Raises:
            EpisodeError: If no episode has begun.
        """
        if self.render_mode is None:
            return None
        world, title = self.world, f"{self.name}, seed {self._drive.seed}"
        if self._picture is None:
            self._picture = LivePicture(self.environment.road_map, title)
        arrivals = {t.id: t.arrived for t in self.environment.trajectory().tracks if t.arrived is not None}
        outcome = self.environment.outcome
        taken = {name: action for name, action in self._drive.actions.items() if isinstance(action, Action)}
        return self._picture.draw(world, taken, outcome=outcome, arrivals=arrivals, title=title)

    def close(self) -> None:
        """Let go of the picture; there is nothing else to close."""
        self._picture = None

    def infos(self, agents: Sequence[str]) -> Infos:
        """Return what there is to say besides, also of agents that have left."""
        return {agent: self._drive.info(agent) for agent in agents}

    def check_masks(self) -> None:
        """Refuse to give masks where there are none."""
        if not isinstance(next(iter(self.action_spaces.values())), Discrete):
            raise EpisodeError(
                "continuous actions have no masks; leave out actions='continuous', or a learner with masks"
            )
