"""Experiences, memories and ways through an episode made by hand, for tests of the memory."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from codriving.config.locate import conf_dir
from codriving.datatypes.experience import Description, Effect, Experience, Interaction, Memory, Verdict
from codriving.datatypes.order import Conflict, Relation
from codriving.datatypes.world import Action, Kind, VehicleState
from codriving.memory.effect import LESSONS, DecisionHistory, HistoryStep, OwnCollision
from codriving.memory.embedders import FeatureEmbedder
from codriving.memory.frozen import FrozenMemory
from codriving.memory.online import OnlineMemory
from codriving.memory.store import MemoryStore
from codriving.reasoning.conflicts import severity, ttcp

LANE = ("a", "b", 0)


def configured_memory(name: str) -> dict[str, Any]:
    """The settings of a memory in the configuration."""
    text = (conf_dir() / "memory" / f"{name}.yaml").read_text(encoding="utf-8")
    return {key: value for key, value in yaml.safe_load(text).items() if key != "_target_"}


def online(at: Path | None, **change: Any) -> OnlineMemory:
    """A memory that learns, as it is configured but for what is named."""
    return OnlineMemory(**{**configured_memory("online"), "file": None if at is None else str(at), **change})


def frozen(at: Path, **change: Any) -> FrozenMemory:
    """A snapshot, as it is configured but for what is named."""
    return FrozenMemory(**{**configured_memory("frozen"), "file": str(at), **change})


def description(
    dttcp: float = 1.0, relation: str = "crossing", order: str = "second", speed: float = 8.0, **numbers: float
) -> Description:
    """A situation with one conflict, or with none."""
    kinds = {"relation": relation, "order": order, "driver": "CAV", "allowed": "FASTER IDLE SLOWER"}
    if relation == "none":
        return Description("Driving.", "No conflict.", "Nothing was agreed.", {"speed": speed, **numbers}, kinds)
    mine, its = 20.0, 20.0 + 8.0 * dttcp
    met = {"mine": mine, "its": its, "my_ttcp": mine / 8, "its_ttcp": its / 8, "dttcp": dttcp, "later": -dttcp}
    known = {"speed": speed, **met, **numbers}
    kinds["severity"] = str(severity(dttcp))
    text = f"{relation.capitalize()} conflict, dTTCP {dttcp:.1f} s, {kinds['severity']}."
    return Description(f"Driving {speed:.1f} m/s.", text, f"The CAV goes {order}.", known, kinds)


def experience(
    told: Description | None = None,
    action: Action = Action.FASTER,
    verdict: Verdict = Verdict.INTENSIFIED,
    step: int = 3,
    ego: str = "CAV1",
) -> Experience:
    """An experience."""
    return Experience(told or description(), action, verdict, Effect(1.0, 0.5, -0.5), LESSONS[verdict], step, ego)


def interaction(seed: int = 20_000, scenario: str = "intersection") -> Interaction:
    """An episode that was learnt from."""
    return Interaction(scenario, seed, "codriving", "full", "rules")


def memory(
    action: Action = Action.FASTER,
    verdict: Verdict = Verdict.INTENSIFIED,
    similarity: float = 0.95,
    count: int = 1,
    number: int = 1,
) -> Memory:
    """An experience that was found for a situation."""
    return Memory(number, f"{action}. {LESSONS[verdict]}", action, verdict, similarity, count)


def filled(path: Path, *episodes: Iterable[Experience], duplicates: float = 0.98, first: int = 20_000) -> Path:
    """A file with what was learnt in some episodes."""
    with MemoryStore(path, FeatureEmbedder(), duplicates) as store:
        for k, learnt in enumerate(episodes):
            store.add(interaction(first + k), list(learnt))
    return path


def noise(seed: int, n: int, dimension: int = 8) -> np.ndarray:
    """Vectors of length 1."""
    vectors = np.random.default_rng(seed).normal(size=(n, dimension))
    return (vectors / np.linalg.norm(vectors, axis=1, keepdims=True)).astype(np.float32)


def vehicle(name: str, x: float, speed: float, y: float = 0.0, heading: float = 0.0) -> VehicleState:
    """A vehicle."""
    kind = Kind.CAV if name.startswith("CAV") else Kind.HDV
    return VehicleState(name, kind, x, y, heading, speed, 0.0, LANE)


def conflict(mine: float, its: float, my_speed: float, its_speed: float, other: str = "CAV2") -> Conflict:
    """A crossing conflict, at so many metres before its zone."""
    times = (ttcp(mine, my_speed), ttcp(its, its_speed))
    return Conflict(
        "CAV1", other, Relation.CROSSING, ("a", "b"), 0, (0.0, 0.0), (mine, its), (mine + 6, its + 6), times,
        abs(times[0] - times[1]), severity(abs(times[0] - times[1])), True,
    )  # fmt: skip


def moment(
    action: Action | None,
    x: float,
    speed: float,
    conflicts: tuple[Conflict, ...] = (),
    others: tuple[VehicleState, ...] = (),
    lead_gap: float | None = None,
    could_go: bool = True,
) -> HistoryStep:
    """One decision of CAV1, which drives along x."""
    return HistoryStep(vehicle("CAV1", x, speed), {o.id: o for o in others}, conflicts, lead_gap, action, could_go)


def crossing_way(
    mine: float,
    its: float,
    my_speeds: list[float],
    its_speeds: list[float],
    action: Action,
    interval: float = 0.5,
    collision: OwnCollision | None = None,
) -> DecisionHistory:
    """CAV1 towards a crossing that CAV2 comes to as well; one speed a moment, the first action is the one judged."""
    moments = []
    for k, (v, w) in enumerate(zip(my_speeds, its_speeds, strict=True)):
        met = (conflict(mine, its, v, w),) if mine > -6 and its > -6 else ()
        others = (vehicle("CAV2", 0.0, w, -its),)
        moments.append(moment(action if k == 0 else Action.IDLE, -mine, v, met, others))
        mine, its = mine - interval * v, its - interval * w
    return DecisionHistory(tuple(moments), interval, collision)


def without_conflicts(way: DecisionHistory) -> DecisionHistory:
    """The same way, but no vehicle is met on it."""
    return replace(way, steps=tuple(replace(m, conflicts=()) for m in way.steps))
