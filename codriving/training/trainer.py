"""The training of MADQN: drive, remember, learn, and validate now and then."""

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch

from codriving.datatypes import Action, Ending
from codriving.gym import draw_seed
from codriving.methods import ACTIONS, FloatArray, Network, feature_count, greedy
from codriving.training.curriculum import shares
from codriving.training.double_dqn import DoubleDqn, as_numpy
from codriving.training.episode import AgentStep, Masks, drive
from codriving.training.nstep import Trail, Transition
from codriving.training.replay import Replay
from codriving.training.settings import MadqnSettings
from codriving.training.validation import features_of

NETWORK, REPLAY = "network.pt", "replay.npz"


@dataclass(slots=True)
class Counts:
    """How far a training is."""

    decisions: int = 0
    episodes: int = 0
    updates: int = 0
    waiting: int = 0
    losses: float = 0.0
    learned: int = 0
    driven: int = 0
    arrived: int = 0


class Trainer:
    """Trains a network; all that it draws comes from one seeded generator."""

    def __init__(self, settings: MadqnSettings) -> None:
        self.settings, self.counts = settings, Counts()
        self._actions = ACTIONS[settings.family]
        inputs = feature_count(settings.family)
        self.rng = np.random.default_rng(settings.seed)
        sizes = (inputs, *settings.hidden, len(self._actions))
        self.learner = DoubleDqn(sizes, settings.average, settings.clip, settings.seed)
        self.replay = Replay(settings.capacity, inputs, len(self._actions))
        self._pull = np.array([settings.faster if a is Action.FASTER else 1.0 for a in self._actions])
        self._roads = [
            [(env, features_of(env, settings.family, settings.shared)) for env in kind.environments(settings.weights)]
            for kind in settings.traffic
        ]

    @property
    def network(self) -> Network:
        """The slow average as it is now, which is what is validated and kept."""
        return as_numpy(self.learner.target, live=False)

    @property
    def decisions(self) -> int:
        """Decisions of single agents so far."""
        return self.counts.decisions

    def advance(self) -> None:
        """Drive one episode and learn on the way."""
        settings, counts = self.settings, self.counts
        share = shares(settings.traffic, counts.decisions / settings.decisions)
        kind = self._roads[int(self.rng.choice(len(share), p=share))]
        env, features = kind[int(self.rng.integers(len(kind)))]
        trails: dict[str, Trail] = {}
        policy = self._explore(as_numpy(self.learner.online, live=True))
        ending: Ending | None = None
        for moment in drive(env, draw_seed(self.rng), features, settings.family, policy):
            for transition in remember(moment, trails, settings.steps, settings.discount):
                self.replay.add(transition)
                counts.waiting += 1
            counts.decisions += len(moment.agents)
            while counts.waiting >= settings.every:
                counts.waiting -= settings.every
                if len(self.replay) >= settings.warm_up:
                    self._learn()
            ending = moment.ending
        counts.episodes += 1
        counts.driven += 1
        counts.arrived += ending is Ending.SUCCESS

    def _learn(self) -> None:
        batch = self.replay.draw(self.settings.batch, self.rng)
        self.counts.losses += self.learner.update(batch, self.settings.rate.at(self.counts.decisions))
        self.counts.learned += 1
        self.counts.updates += 1

    def _explore(self, network: Network) -> Callable[[FloatArray, Masks], list[int]]:
        """The best action of the network as it is, or one drawn, each agent for itself."""

        def decide(observations: FloatArray, masks: Masks) -> list[int]:
            chosen = greedy(network(observations), masks)
            share = self.settings.exploration.at(self.counts.decisions)
            for k, explores in enumerate(self.rng.random(len(chosen)) < share):
                if explores:
                    pull = self._pull * masks[k]
                    chosen[k] = int(self.rng.choice(len(pull), p=pull / pull.sum()))
            return chosen

        return decide

    def section(self) -> dict[str, float | int | None]:
        """Return what a row of the curve says besides the exams, and begin the next section."""
        counts = self.counts
        row = {
            "decisions": counts.decisions,
            "episodes": counts.episodes,
            "updates": counts.updates,
            "epsilon": round(self.settings.exploration.at(counts.decisions), 4),
            "loss": round(counts.losses / counts.learned, 5) if counts.learned else None,
            "train_success": round(counts.arrived / counts.driven, 4) if counts.driven else None,
        }
        counts.losses, counts.learned, counts.driven, counts.arrived = 0.0, 0, 0, 0
        return row

    def write(self, folder: Path) -> dict[str, Any]:
        """Write the network and the replay, and return what else the training goes on from."""
        torch.save(self.learner.state(), folder / NETWORK)
        np.savez(folder / REPLAY, **self.replay.state())  # type: ignore[arg-type]
        return {"counts": asdict(self.counts), "rng": self.rng.bit_generator.state}

    def read(self, folder: Path, state: dict[str, Any]) -> None:
        """Go on from what another one has written."""
        self.learner.restore(torch.load(folder / NETWORK, weights_only=True))
        with np.load(folder / REPLAY, allow_pickle=False) as replay:
            self.replay.restore(dict(replay))
        self.counts = Counts(**state["counts"])
        self.rng.bit_generator.state = state["rng"]


def remember(moment: AgentStep, trails: dict[str, Trail], steps: int, discount: float) -> Iterator[Transition]:
    """Turn one step of all agents into transitions.

    A CAV that has arrived or crashed has nothing to come. At the time limit the others would have gone on. When others
    crash, the last step of who had no part in it is dropped.
    """
    for k, name in enumerate(moment.agents):
        trail = trails.setdefault(name, Trail(steps, discount))
        trail.add(moment.observations[k], moment.masks[k], moment.actions[k], moment.rewards[k])
        if name in moment.arrived or name in moment.failed:
            yield from trail.ended()
        elif moment.ending is Ending.TIMEOUT:
            yield from trail.cut(moment.later[name], moment.allowed[name])
        elif moment.ending is not None:
            yield from trail.dropped()
        else:
            yield from trail.full(moment.later[name], moment.allowed[name])
