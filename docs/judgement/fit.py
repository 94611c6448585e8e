"""Fits the coefficients of ``judgement=learned``: asks the world itself whether each driver lets the CAV pass.

An episode is driven by the rules. At moments drawn by the seed the world is copied, and in the copy the CAV goes on;
whether the driver then lets it pass is what is to be foretold.

    python docs/judgement/fit.py codriving/judgement/coefficients.json standoff:1000001:40 crowd:1000041:18

takes the file to write, and of each suite the first seed and the number of seeds.
"""

import json
import sys
from collections.abc import Sequence
from copy import deepcopy
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from codriving.config import build, compose
from codriving.datatypes import (
    Action,
    CaseMemory,
    Judgements,
    Method,
    Model,
    Role,
    RuleModel,
    Simulator,
    WorldState,
)
from codriving.geometry import progress
from codriving.judgement.contests import FEATURES, Contest
from codriving.judgement.hindsight import entries, let_pass
from codriving.judgement.judge import Judge
from codriving.judgement.learned import fit
from codriving.methods import CoDriving

FIRST = 1_000_000  # Seeds below are for tuning and for tables
SHARE = 0.5  # Of the open pairs of each step, how many are asked about
LONGEST = 12.0  # How long the CAV goes on in a copy [s]
CLEARS = 2.0  # How long after it has come to the zone a collision says that it was not let pass [s]
ROOM = (4.0, 1.5)  # Distance [m] and time [s] to the vehicle ahead below which it does as the rules do


class Noting(Judge):
    """Keeps what is asked, and leaves the answer to the rules of the road."""

    name = "noting"

    def __init__(self) -> None:
        self.asked: list[Contest] = []

    def judge(self, asked: Sequence[Contest]) -> Judgements:
        self.asked = list(asked)
        return {}


def moments(suite: str, seed: int) -> list[tuple[dict[str, float], bool]]:
    """Drive one episode; return the numbers of some open pairs, and whether the driver lets the CAV pass."""
    if seed < FIRST:
        raise SystemExit(f"seeds of a training begin at {FIRST:,}, got {seed}")
    config = compose([f"suite={suite}", "method=codriving"])
    environment = build(config["environment"], Simulator, "environment")
    method = build(config["method"], Method, "method", given={Model: RuleModel(), CaseMemory: None})
    assert isinstance(method, CoDriving)
    judge, rng, found = Noting(), np.random.default_rng(seed), []
    method.rely_on(judge)
    world = environment.reset(seed)
    method.reset(environment.road_map, environment.driving_model, seed)
    shared = {id(part): part for part in (environment.road_map, environment.driving_model, environment.scenario)}
    while environment.outcome is None:
        judge.asked = []
        before = deepcopy(method, dict(shared))
        actions = method.act(world).actions
        for contest in judge.asked:
            if rng.random() < SHARE:
                copied = deepcopy((environment, before), dict(shared))
                truth = lets_pass(*copied, world, contest)
                if truth is not None:
                    found.append((dict(contest.numbers), truth))
        world = environment.step(actions)
    return found


def lets_pass(environment: Simulator, method: CoDriving, world: WorldState, contest: Contest) -> bool | None:
    """Let a CAV go on, and see who of both comes first; None if neither comes to their zone."""
    began, first, passed = world.time, None, 0.0
    while environment.outcome is None and world.time < began + LONGEST:
        deliberation = method.act(world)
        actions = deliberation.actions
        scene = next((s.scene for s in deliberation.situations if s.scene.ego.id == contest.cav), None)
        ahead = scene.next_in(Role.LEADING) if scene is not None else None
        if scene is not None and (ahead is None or (ahead.gap or 0.0) > ROOM[0] + ROOM[1] * scene.ego.speed):
            actions = {**actions, contest.cav: Action.FASTER}
        world = environment.step(actions)
        if first is None:
            first, passed = came_first(environment, contest, began), world.time
        if first is False or scene is None or (first and world.time > passed + CLEARS):
            break
    outcome = environment.outcome
    if outcome is not None and {contest.cav, contest.human} <= set(outcome.failed):
        return False  # It did not let it pass
    return first


def came_first(environment: Simulator, contest: Contest, began: float) -> bool | None:
    """Whether the CAV was at their next zone before the driver; None if neither was yet, True if they do not meet."""
    trajectory, road_map = environment.trajectory(), environment.road_map
    tracks = {track.id: track for track in trajectory.tracks if track.id in (contest.cav, contest.human)}
    places = {name: progress(road_map.paths[t.route], t.x, t.y, t.heading) for name, t in tracks.items()}
    pair = tracks[contest.cav], tracks[contest.human]
    entered = entries(*pair, places, road_map, trajectory.step)
    return let_pass(entered, began) if any(min(both) > began for both in entered) else True


def main(file: Path, told: Sequence[str]) -> None:
    """Collect, see how well each eighth of the episodes is foretold by the others, fit and write."""
    parts = [(suite, int(first), int(count)) for suite, first, count in (text.split(":") for text in told)]
    each = [moments(suite, seed) for suite, first, count in parts for seed in range(first, first + count)]
    rows = np.array([[numbers[name] for name in FEATURES] for found in each for numbers, _ in found])
    truth = np.array([float(yields) for found in each for _, yields in found])
    fold = np.repeat(np.arange(len(each)), [len(found) for found in each]) % 8
    foretold = np.zeros(len(truth))
    for k in range(8):
        weights, bias = fit(rows[fold != k], truth[fold != k])
        foretold[fold == k] = 1 / (1 + np.exp(-(rows[fold == k] @ weights + bias)))
    weights, bias = fit(rows, truth)
    written = {
        "date": datetime.now(UTC).date().isoformat(),
        "seeds": {suite: f"{first} to {first + count - 1}" for suite, first, count in parts},
        "moments": len(truth),
        "let_pass": round(float(truth.mean()), 3),
        "accuracy_left_out": round(float(((foretold > 0.5) == truth).mean()), 3),
        "brier_left_out": round(float(((foretold - truth) ** 2).mean()), 3),
        "bias": round(bias, 6),
        "weights": {name: round(float(weight), 6) for name, weight in zip(FEATURES, weights, strict=True)},
    }
    file.write_text(json.dumps(written, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
