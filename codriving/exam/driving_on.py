"""What comes of an answer: the world is copied, and driven on with it."""

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from codriving.datatypes import BLOCKER, Action, Kind, Method, Pair, Situation, Track, Trajectory, WorldState
from codriving.environment import Environment
from codriving.exam.copies import Copies
from codriving.exam.observed import notebook_of
from codriving.exam.stored import NEAR_MISS, Consequence
from codriving.judgement import Contest, lets_pass
from codriving.metrics import post_encroachment_times

HELD = 2  # Decisions for which an action is kept, if it can be
HORIZON = 4.0  # How long is driven on [s]
DRAWS = 5  # Of the styles of human drivers
REGAINS = 2.0  # Acceleration with which a vehicle is taken to come back to its speed after that [m/s2]

_Passed = tuple[str, str, str, float]  # Who passed first, who second, in which kind of conflict, and the PET [s]

Chosen = Callable[[int, WorldState, Mapping[str, Action]], Mapping[str, Action]]


@dataclass(frozen=True, slots=True)
class _Drive:
    collided: bool
    near_miss: bool
    lost: float  # [s]


@dataclass(frozen=True, slots=True)
class _NotedStep:
    time: float
    actions: Mapping[str, Action]
    situations: Sequence[Situation]


class Copied:
    """A world at one moment, with the methods that may drive it on, written down once for all copies."""

    def __init__(self, environment: Environment, continuations: Sequence[Method], world: WorldState, seed: int) -> None:
        self.environment, self.continuations, self.world, self.seed = environment, continuations, world, seed
        self._copies: dict[int, Copies] = {}

    def copy(self, method: Method) -> tuple[Environment, Method]:
        """Copy the world and one that drives it on, both as they were when the first copy was made."""
        if id(method) not in self._copies:
            self._copies[id(method)] = self._written(method)
        environment, copied = self._copies[id(method)].another()
        return environment, copied

    def _written(self, method: Method) -> Copies:
        notebook = notebook_of(method)
        notebook.closed = True
        observer, self.environment.observer = self.environment.observer, method.observer
        try:
            return Copies((self.environment, method), (*self.environment.lasting, notebook))
        finally:
            self.environment.observer = observer

    def of_actions(self, situation: Situation, quick: bool = False) -> dict[Action, Consequence]:
        """Let a CAV do each action that is allowed; `quick` takes one continuation and one draw."""
        ego, ends = situation.scene.ego.id, self.environment.driving_model.target_speeds
        alike: dict[object, list[Action]] = {}
        for a in (a for a in situation.assessments if a.safe):
            # Actions that set the same speed now and later are driven once.
            same = a.action in (Action.IDLE, Action.HOLD) or a.target in (ends[0], ends[-1])
            alike.setdefault(a.target if same and a.target is not None else a.action, []).append(a.action)

        def choose(action: Action) -> Chosen:
            def chosen(step: int, world: WorldState, wanted: Mapping[str, Action]) -> Mapping[str, Action]:
                stays = step == 0 or (step < HELD and action not in (Action.LANE_LEFT, Action.LANE_RIGHT))
                may = ego in wanted and action in world.available[ego]
                return {**wanted, ego: action} if stays and may else wanted

            return chosen

        judged = _compared([self._drives((ego,), choose(actions[0]), {}, quick) for actions in alike.values()])
        found = {action: one for actions, one in zip(alike.values(), judged, strict=True) for action in actions}
        return {action: found[action] for action in situation.allowed}

    def of_orders(self, pair: Pair, quick: bool = False) -> tuple[Consequence, Consequence]:
        """Let the first of a pair go first, and then the other one."""
        why = "so it is asked"
        first, second = _compared(
            [
                self._drives(pair, lambda _, __, wanted: wanted, {order: why}, quick)
                for order in (pair, (pair[1], pair[0]))
            ]
        )
        return first, second

    def lets_pass(self, contest: Contest) -> bool | None:
        """Let a CAV go on by the first continuation, the driver being who it is; None if neither comes there."""
        environment, method = self.copy(self.continuations[0])
        notebook = notebook_of(method)

        def act(world: WorldState) -> _NotedStep:
            notebook.empty()
            return _NotedStep(
                world.time, method.act(world).actions, [situation for situation, _ in notebook.situations]
            )

        return lets_pass(environment, act, act(self.world), contest)

    def _drives(self, who: tuple[str, ...], choose: Chosen, forced: Mapping[Pair, str], quick: bool) -> list[_Drive]:
        pets = {name: self._pets_of(name, self.environment.trajectory()) for name in who}
        found = []
        for method in self.continuations[: 1 if quick else None]:
            notebook = notebook_of(method)
            for draw in range(1 if quick else DRAWS):
                notebook.forced.update(forced)
                found.append(self._drive(method, draw, who, choose, pets))
                notebook.forced.clear()
        return found

    def _drive(
        self, method: Method, draw: int, who: tuple[str, ...], choose: Chosen, pets: Mapping[str, set[_Passed]]
    ) -> _Drive:
        environment, method = self.copy(method)
        environment.redraw_drivers(_seed_of(self.seed, draw))
        world, began, step = self.world, self.world.time, 0
        while environment.outcome is None and world.time < began + HORIZON - 1e-6:
            world = environment.step(choose(step, world, method.act(world).actions))
            step += 1
        outcome, trajectory = environment.outcome, environment.trajectory()
        collided = outcome is not None and bool(set(who) & set(outcome.failed))
        new = [self._pets_of(name, trajectory) - pets[name] for name in who]
        near = any(passed[3] < NEAR_MISS for found in new for passed in found)
        return _Drive(collided, near, lost(trajectory, began, world.time, environment.driving_model.top_speed))

    def _pets_of(self, name: str, trajectory: Trajectory) -> set[_Passed]:
        """Return the PETs of one vehicle so far."""
        tracks = {track.id: track for track in trajectory.tracks}
        found: set[_Passed] = set()
        for other in tracks.values():
            if name in tracks and other.id != name:
                both = Trajectory(trajectory.step, (tracks[name], other))
                pets = post_encroachment_times(both, self.environment.road_map)
                found |= {(pet.first, pet.second, pet.kind, round(pet.value, 6)) for pet in pets}
        return found


def lost(trajectory: Trajectory, began: float, ends: float, speed: float) -> float:
    """Return how much time all vehicles together lost against driving at a speed [m/s] from a time on [s].

    Who is slower at the end loses on until it is back at that speed.
    """
    return sum(
        _lost(track, trajectory.step, began, ends, speed) for track in trajectory.tracks if track.style != BLOCKER
    )


def _lost(track: Track, step: float, began: float, ends: float, speed: float) -> float:
    start = round(began / step) - track.first_step
    last = len(track.x) - 1
    if start >= last:
        return 0.0
    there = track.arrived is not None or track.first_step + last < round(ends / step)
    if track.arrived is not None and track.kind is Kind.CAV:
        last = min(max(round(track.arrived / step) - track.first_step, start + 1), last)
    rows = slice(max(start, 0), last + 1)
    driven = float(np.hypot(np.diff(track.x[rows]), np.diff(track.y[rows])).sum())
    time = (last - max(start, 0)) * step
    slower = 0.0 if there else max(speed - float(track.speed[last]), 0.0)
    return time - driven / speed + slower**2 / (2 * REGAINS * speed)


def _compared(drives: Sequence[Sequence[_Drive]]) -> list[Consequence]:
    """Sum up the drives of each answer; times are against the fastest that is safe and without a near miss."""
    lost_each = [float(np.mean([drive.lost for drive in of])) for of in drives]
    bad = [(sum(d.collided for d in of), sum(d.near_miss for d in of)) for of in drives]
    fine = [time for time, (collided, near) in zip(lost_each, bad, strict=True) if not collided and not near]
    best = min(fine or lost_each)
    return [
        Consequence(len(of), collided, near, round(time - best, 3))
        for of, time, (collided, near) in zip(drives, lost_each, bad, strict=True)
    ]


def _seed_of(seed: int, draw: int) -> int:
    return int.from_bytes(hashlib.sha256(f"drivers of the exam, episode {seed}, draw {draw}".encode()).digest()[:6])
