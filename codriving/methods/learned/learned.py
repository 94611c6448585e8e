"""Methods that have learned: every CAV asks the same trained network, and acts on what it observes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from codriving.datatypes import Action, Deliberation, DrivingModel, Method, Road, Shares, WorldState
from codriving.errors import WeightsError
from codriving.geometry import RoadMap
from codriving.methods.learned.features import Features, Observation
from codriving.methods.learned.layout import ACTIONS, allowed, family_of, feature_names
from codriving.methods.learned.network import greedy, shares
from codriving.methods.learned.weights import Trained, load, shipped, sidecar

VALUES, PROBABILITIES = "values", "probabilities"

REASONS = {VALUES: ("the network expects the most of", ".2f"), PROBABILITIES: ("the policy prefers", ".0%")}


@dataclass(frozen=True, slots=True)
class Judged(Deliberation):
    """One decision step of a learned method."""

    time: float  # Simulated time [s]
    step: int
    family: str
    routes: Mapping[str, str]
    observations: Mapping[str, Observation]
    values: Mapping[str, Mapping[Action, float]]
    chosen: Mapping[str, Action]
    counts: Mapping[str, float]
    meaning: str = VALUES  # What the values are, ``values`` or ``probabilities``

    @property
    def actions(self) -> dict[str, Action]:
        return dict(self.chosen)

    def as_dict(self) -> dict[str, Any]:
        cavs = [self._entry(name, action) for name, action in self.chosen.items()]
        return {"time": self.time, "step": self.step, "cavs": cavs}

    def _entry(self, name: str, action: Action) -> dict[str, Any]:
        values = self.values[name]
        words, form = REASONS[self.meaning]
        others = [f"{other} {value:{form}}" for other, value in values.items() if other is not action]
        numbers = zip(feature_names(self.family), self.observations[name].tolist(), strict=True)
        # Empty slots are all zeros; what is not named is zero.
        observed = {feature: round(value, 6) for feature, value in numbers if value}
        return {
            "id": name,
            "action": str(action),
            "reason": f"{words} {action}: {values[action]:{form}}, against {', '.join(others)}",
            "scene": {"intent": {"route": self.routes[name]}},
            "observed": observed,
            self.meaning: {str(a): round(value, 6) for a, value in values.items()},
        }


class Learned(Method):
    """Drives with trained weights, those of the family of the road; the best action is taken, and nothing is drawn."""

    shared: ClassVar[bool]
    meaning: ClassVar[str]  # What the network says of an action, ``values`` or ``probabilities``

    def __init__(self, weights: Path | None) -> None:
        self.shares = Shares(states=self.shared, intents=self.shared)
        self._file = weights
        self._trained: dict[Path, Trained] = {}
        self._own: str | None = None
        self.variant = ""
        if weights is not None:
            trained = load(weights)
            if trained.purpose.method != self.name:
                raise WeightsError(f"{weights} holds weights of {trained.purpose.method}, not of {self.name}")
            self._own, self.variant = trained.purpose.family, "own weights"
            self._trained[weights] = trained

    def check_road(self, road: Road, target_speeds: Sequence[float], decision_interval: float) -> None:
        for limited in (True, False):
            self._weights(road, limited).purpose.check(family_of(road), target_speeds, decision_interval)

    def remark(self, road: Road, world: Mapping[str, str]) -> str:
        trained = self._weights(road, world.get("limits") != "none").purpose.world
        if all(world.get(group, name) == name for group, name in trained.items()):
            return ""
        names = " ".join(f"{group}={name}" for group, name in trained.items())
        return f"{self.name}: its weights were trained in another world, {names}."

    def files(self, road: Road, limited: bool) -> Mapping[str, Path]:
        file = self._file or shipped(self.name, family_of(road), limited)
        return {"weights": file, "weights, purpose": sidecar(file)}

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self.check_road(road_map.road, model.target_speeds, model.decision_interval)
        self._family = family_of(road_map.road)
        self._network = self._weights(road_map.road, model.limits is not None).network
        self._features = Features(road_map, model, self._family, self.shared)

    def act(self, world: WorldState) -> Judged:
        """Decide for every CAV on the road."""
        observations = self._features.observe(world)
        outputs = ACTIONS[self._family]
        masks = np.array([allowed(self._family, world.available[name]) for name in observations])
        seen = np.stack(list(observations.values())) if observations else None
        judged = np.empty((0, len(outputs)), np.float32) if seen is None else self._network(seen)
        chosen = [] if seen is None else greedy(judged, masks)
        if self.meaning == PROBABILITIES:
            judged = shares(judged, masks)
        values = {
            name: {a: float(q) for a, q, ok in zip(outputs, row, mask, strict=True) if ok}
            for name, row, mask in zip(observations, judged, masks, strict=True)
        }
        actions = {name: outputs[k] for name, k in zip(observations, chosen, strict=True)}
        routes = {name: world.intents[name].route for name in observations}
        return Judged(world.time, world.step, self._family, routes, observations, values, actions, {}, self.meaning)

    def _weights(self, road: Road, limited: bool) -> Trained:
        family = family_of(road)
        if self._own not in (None, family):
            given = f"the weights that were given are for roads of the family {self._own}"
            raise WeightsError(f"{given}, this road is one of {family}")
        file = self._file or shipped(self.name, family, limited)
        if file not in self._trained:
            self._trained[file] = load(file)
        return self._trained[file]
