"""A world of one CAV and one human on a straight line, quick to drive and easy to break; importable by workers."""

import os
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

from codriving.datatypes.parts import Method, Metric, Scenario, Simulator
from codriving.datatypes.record import Collision, Ending, Outcome, Pet, Score, Track, Trajectory, TravelScore
from codriving.datatypes.situation import Deliberation
from codriving.datatypes.world import Action, DrivingModel, Intent, Kind, Scene, VehicleState, WorldState
from codriving.experiment.episode import Labels, seed_of_method
from codriving.experiment.launchers import Launcher
from codriving.experiment.scoring import settings_of_metric
from codriving.experiment.worker import Job, Objects, Report, Unit
from codriving.metrics.scorer import Scorer

LABELS = Labels("toy", "steady", "full", "rules")
LANE = ("a", "b", 0)


class ToyScenario(Scenario):
    """Nothing but a name."""

    name = "toy"
    road = None  # type: ignore[assignment]
    pace = SimpleNamespace(target_speeds=(0.0, 5.0), decision_frequency=1.0)

    def scene(self, seed: int) -> Scene:
        """None at all."""
        raise NotImplementedError


class ToyEnvironment(Simulator):
    """Success past 20 m; every seventh seed collides."""

    road_map = "the map"
    driving_model = DrivingModel((0.0, 5.0), 1.6, 1.0, 1.0, 50.0)

    def __init__(self) -> None:
        self._outcome: Outcome | None = None
        self._rows: list[float] = []
        self._speed = 0.0
        self._seed = 0

    @property
    def outcome(self) -> Outcome | None:
        """How it ended."""
        return self._outcome

    def reset(self, seed: int) -> WorldState:
        """Begin."""
        if seed < 0:
            raise ValueError("seeds are not negative")
        self._seed = seed
        self._outcome = None
        self._rows = [0.0]
        self._speed = float(np.random.default_rng(seed).uniform(3.0, 6.0))
        return self._world()

    def step(self, actions: Mapping[str, Action]) -> WorldState:
        """Drive one second."""
        assert set(actions) == {"CAV1"}
        self._rows.append(self._rows[-1] + self._speed)
        time = float(len(self._rows) - 1)
        if self._seed % 7 == 6 and time >= 2:
            hit = Collision(time, "CAV1", "HDV1", "CAV-HDV")
            self._outcome = Outcome(Ending.COLLISION, time, {}, collision=hit)
        elif self._rows[-1] > 20.0:
            self._outcome = Outcome(Ending.SUCCESS, time, {"CAV1": time})
        return self._world()

    def trajectory(self) -> Trajectory:
        """What was driven, the human first."""
        n = len(self._rows)
        x, zero = np.array(self._rows), np.zeros(n)
        arrived = None if self.outcome is None else self.outcome.arrivals.get("CAV1")
        cav = Track("CAV1", Kind.CAV, "west-east", 0, x, zero, zero, zero + self._speed, zero, ("IDLE",) * n, arrived)
        hdv = Track("HDV1", Kind.HDV, "east-west", 0, -x, zero, zero, zero, zero, ("",) * n, None)
        return Trajectory(1.0, (hdv, cav))

    def _world(self) -> WorldState:
        x, step = self._rows[-1], len(self._rows) - 1
        cav = VehicleState("CAV1", Kind.CAV, x, 0.0, 0.0, self._speed, 0.0, LANE)
        return WorldState(float(step), step, (cav,), {"CAV1": Intent("west-east", 5.0, LANE)}, {"CAV1": tuple(Action)})


EPISODES = {seed_of_method(seed): seed for seed in range(2000)}


@dataclass(frozen=True)
class ToyDeliberation(Deliberation):
    """Stay as you are."""

    chosen: Mapping[str, Action]
    step: int
    counts: Mapping[str, int] = field(default_factory=lambda: {"fallbacks": 1})

    @property
    def actions(self) -> dict[str, Action]:
        """What was chosen."""
        return dict(self.chosen)

    def as_dict(self) -> dict[str, Any]:
        """One line, with a number that JSON does not know."""
        return {"step": self.step, "actions": dict(self.actions), "ttcp": float("inf")}


@dataclass
class ToyMethod(Method):
    """Drives on; breaks, dies or waits where it is told to."""

    raises: tuple[int, ...] = ()
    dies: tuple[int, ...] = ()
    gate: Path | None = None
    waits_from: int = 0
    dies_once: bool = False
    name: str = "steady"
    variant: str = "full"
    reasoner: str = "rules"
    seed: int = -1

    def reset(self, road_map: object, model: DrivingModel, seed: int) -> None:
        """Take note of the episode; a method is not told its seed, so it is looked up among the small ones."""
        assert road_map == "the map"
        self.seed = EPISODES[seed]

    def act(self, world: WorldState) -> ToyDeliberation:
        """Go on, or do what the test wants."""
        if self.gate is not None:
            self._at_gate(self.gate)
        if self.seed in self.raises and world.step == 1:
            raise RuntimeError(f"seed {self.seed}\nbroke")
        return ToyDeliberation({"CAV1": Action.IDLE}, world.step)

    def _at_gate(self, gate: Path) -> None:
        if self.seed in self.dies and not (self.dies_once and (gate / f"died-{self.seed}").exists()):
            with (gate / f"died-{self.seed}").open("a") as file:
                file.write("x")
            os.kill(os.getpid(), 9)
        if self.seed >= self.waits_from and (gate / "fifo").exists():
            (gate / f"waiting-{os.getpid()}").touch()
            # Opening a pipe that no process writes to blocks for ever, without a clock.
            (gate / "fifo").open().close()


class ToyMetrics(Metric):
    """A PET per seed, the speed of the CAV; NaN where it is told to."""

    name = "toy"

    def __init__(self, nan: tuple[int, ...] = ()) -> None:
        self._nan = nan

    def score(self, trajectory: Trajectory, outcome: Outcome, road: object) -> Score:
        """One PET and one velocity."""
        cav = trajectory.tracks[1]
        value = float("nan") if round(outcome.time) in self._nan else 1.0 + outcome.time / 10.0
        travel = TravelScore("CAV1", float(cav.speed[0]), outcome.time, None)
        return Score(outcome.ending is Ending.SUCCESS, (Pet("CAV1", "HDV1", "crossing", value),), (travel,))


class Batch(NamedTuple):
    """What became of a batch."""

    done: int
    failed: list[Report]


def run_batch(units: Sequence[Unit], job: Job, launcher: Launcher, workers: int) -> Batch:
    """Drive a batch to its end."""
    with closing(launcher.launch(units, job, workers, ())) as launched:
        reports = list(launched)
    return Batch(len(reports), [report for report in reports if report.ending is Ending.ERROR])


def toy_scorers(config: Mapping[str, Any], nan: tuple[int, ...] = ()) -> dict[str, Scorer]:
    """The toy metric under the names and settings of those of a config."""
    named = config.get("metrics", {"toy": {}})
    return {name: Scorer(ToyMetrics(nan), settings_of_metric(node)) for name, node in named.items()}


@dataclass(frozen=True)
class BuildToy:
    """Builds the toy; picklable, with the settings of a test."""

    raises: tuple[int, ...] = ()
    dies: tuple[int, ...] = ()
    gate: Path | None = None
    waits_from: int = 0
    nan: tuple[int, ...] = ()
    dies_once: bool = False
    configs: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    def __call__(self, cell: str) -> Objects:
        """Build them, whatever the cell."""
        method = ToyMethod(self.raises, self.dies, self.gate, self.waits_from, self.dies_once)
        return Objects(ToyEnvironment(), method, toy_scorers(self.configs.get(cell, {}), self.nan))
