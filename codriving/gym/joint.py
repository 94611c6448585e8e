"""All CAVs in one hand: our environment as a Gymnasium `Env`."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.spaces import Box, Discrete, MultiDiscrete
from numpy.typing import NDArray

from codriving.errors import EpisodeError
from codriving.gym.episode import Info
from codriving.gym.observation import FloatArray
from codriving.gym.one_agent import OverParallel
from codriving.gym.parallel import ParallelDriving


class JointDriving(OverParallel):
    """One agent that decides for all CAVs: observations and actions are the products of theirs (paper Section II)."""

    def __init__(self, name: str, overrides: Sequence[str] = (), suite: str = "default", **settings: Any) -> None:  # noqa: ANN401
        super().__init__(ParallelDriving(name, f"suite={suite}", *overrides, **settings))
        self.observation_space = self.parallel.state_space
        spaces = list(self.parallel.action_spaces.values())
        discrete = [int(space.n) for space in spaces if isinstance(space, Discrete)]
        self.action_space = MultiDiscrete(discrete) if discrete else Box(-1.0, 1.0, (len(spaces), 2), np.float32)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[FloatArray, Info]:
        """Begin an episode."""
        self.parallel.reset(self.seed_of(seed))
        return self.parallel.state(), self._info()

    def step(self, action: NDArray[Any]) -> tuple[FloatArray, float, bool, bool, Info]:
        """Carry out one decision of every CAV."""
        agents = self.parallel.possible_agents
        numbers = np.asarray(action).tolist()
        if not isinstance(numbers, list) or len(numbers) != len(agents):
            raise EpisodeError(f"one action for each of {', '.join(agents)} is needed, got {action!r}")
        rewards, _, truncated = self.parallel.advance(dict(zip(agents, numbers, strict=True)))
        late = any(truncated.values())
        # A CAV that has arrived is rewarded no more, so that the return is the mean of the returns of the CAVs.
        reward = sum(rewards.values()) / len(agents)
        return self.parallel.state(), reward, not late and not self.parallel.agents, late, self._info()

    def action_masks(self) -> NDArray[np.bool_]:
        """Return the masks of all CAVs one after another, as MaskablePPO of sb3-contrib wants them.

        Raises:
            EpisodeError: If actions are continuous, which have no masks.
        """
        self.parallel.check_masks()
        return np.concatenate([info["action_mask"] for info in self._infos()]).astype(np.bool_)

    def _info(self) -> Info:
        infos = self._infos()
        masks = [info["action_mask"] for info in infos if "action_mask" in info]
        return {
            **({"action_mask": np.stack(masks)} if masks else {}),
            "arrived": np.array([info["arrived"] for info in infos]),
            "refused": sum(info["refused"] for info in infos),
            "outcome": infos[0]["outcome"],
            "crashed": np.array([info["crashed"] for info in infos]),
            "involved": infos[0]["involved"],
            "seed": infos[0]["seed"],
        }

    def _infos(self) -> list[Info]:
        return list(self.parallel.infos(self.parallel.possible_agents).values())
