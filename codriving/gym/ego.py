"""One CAV in one hand, among CAVs that keep to the rules: our environment as a Gymnasium `Env`."""

from collections.abc import Sequence
from inspect import signature
from typing import Any

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from codriving.errors import ConfigError, EpisodeError
from codriving.gym.configured import configured_method
from codriving.gym.episode import Info
from codriving.gym.observation import FloatArray
from codriving.gym.one_agent import OverParallel
from codriving.gym.parallel import ParallelDriving

WORDS = frozenset(signature(ParallelDriving).parameters)  # All other settings are keys of the scenario

DRAW = 3  # Key of the random numbers of the method, apart from those of the scene and of the drivers


class EgoDriving(OverParallel):
    """One agent that drives one CAV; a method decides for all other CAVs.

    Args:
        ego: The CAV that the agent drives.
        others: The method of the other CAVs, by the built-in rules; a name of ``method=``.

    Raises:
        ConfigError: If a setting cannot be used.
    """

    def __init__(
        self,
        name: str,
        overrides: Sequence[str] = (),
        suite: str = "default",
        ego: str = "CAV1",
        others: str = "codriving",
        **settings: Any,  # noqa: ANN401 - as for ``codriving.parallel_env``
    ) -> None:
        world = (f"suite={suite}", *overrides)
        super().__init__(ParallelDriving(name, *world, **settings))
        if ego not in self.parallel.possible_agents:
            raise ConfigError(f"ego must be one of {', '.join(self.parallel.possible_agents)}, got {ego!r}")
        environment = self.parallel.environment
        keys = {key: value for key, value in settings.items() if key not in WORDS}
        cda, folder = settings.get("cda", "full"), settings.get("config_dir")
        self.ego, self.others = ego, configured_method(name, world, others, cda, folder, keys)
        if self.others.hands_over:
            raise ConfigError(f"others={others!r} hands all CAVs over to human drivers; choose a method that decides")
        model = environment.driving_model
        self.others.check_road(environment.scenario.road, model.target_speeds, model.decision_interval)
        self.observation_space: Box = self.parallel.observation_space(ego)  # type: ignore[assignment]
        self.action_space = self.parallel.action_space(ego)
        self._over = True

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[FloatArray, Info]:
        """Begin an episode; a seed means the same vehicles as in `codriving run`."""
        chosen = self.seed_of(seed)
        observations, infos = self.parallel.reset(chosen)
        environment = self.parallel.environment
        draws = np.random.SeedSequence(entropy=chosen, spawn_key=(DRAW,))
        self.others.reset(environment.road_map, environment.driving_model, int(draws.generate_state(1)[0]))
        self._over = False
        return observations[self.ego], infos[self.ego]

    def step(self, action: object) -> tuple[FloatArray, float, bool, bool, Info]:
        """Carry out one decision; the episode ends when the ego vehicle has arrived.

        Raises:
            EpisodeError: If no episode is going on, or there is no such action.
        """
        if self._over:
            raise EpisodeError("no episode is going on; call reset() before step(action)")
        if self.others.knows_drivers:
            self.others.be_told(self.parallel.environment.manners())
        decided = self.others.act(self.parallel.world).actions
        ego, turn = self.ego, self.parallel.step({**decided, self.ego: action})
        observations, rewards, terminated, truncated, infos = turn
        self._over = terminated[ego] or truncated[ego]
        return observations[ego], rewards[ego], terminated[ego], truncated[ego], infos[ego]

    def action_masks(self) -> NDArray[np.bool_]:
        """Return the mask of the ego vehicle, as MaskablePPO of sb3-contrib wants it.

        Raises:
            EpisodeError: If actions are continuous, which have no masks.
        """
        self.parallel.check_masks()
        mask: NDArray[np.bool_] = self.parallel.infos([self.ego])[self.ego]["action_mask"].astype(np.bool_)
        return mask
