"""Moments in which it is open whether a human driver lets a CAV pass, each with what the driver then did."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from codriving.config import build, compose
from codriving.datatypes import CaseMemory, Judgements, Manner, Method, Model, RuleModel
from codriving.environment import Environment
from codriving.exam.copies import Copies
from codriving.exam.file import read_lines, written_lines
from codriving.exam.plain import plain
from codriving.judgement import Contest, Judge, entered, let_pass, lets_pass
from codriving.methods import CoDriving

KIND, BUILDER = "judged moments", "docs/judgement/moments.py"

WORLDS: Mapping[str, tuple[str, ...]] = {
    **{
        f"{scenario}, {drivers}": (f"scenario={scenario}", f"drivers={drivers}")
        for scenario in ("intersection", "roundabout", "merge")
        for drivers in ("mixed", "rough")
    },
    **{name: (f"suite={name}",) for name in ("standoff", "crowd", "blind", "blocked_exit", "ring", "busy_merge")},
}

SEEDS = range(29_000, 29_960)  # On which nothing is tuned; each world has so many as the others, in order


@dataclass(frozen=True, slots=True)
class JudgedMoment:
    """One CAV and one human driver at one step, and what the driver then did."""

    world: str
    seed: int
    time: float  # [s]
    contest: Contest
    style: str  # How the driver drives, which no vehicle can know
    manner: Manner  # The same, as it is told to an oracle
    yields: bool  # Whether it let the CAV pass when that one went on
    came: bool | None  # Whether it did in the episode, as the rules drove it; None if they did not meet


@dataclass(frozen=True, slots=True)
class StoredMoments:
    """Judged moments, and where they come from."""

    moments: tuple[JudgedMoment, ...]
    about: Mapping[str, str]  # Version, behaviour number, and seeds
    sha256: str = ""  # Of its file; empty before it is written


class _Noting(Judge):
    """Keeps what is asked, and leaves the answer to the rules of the road."""

    name = "noting"

    def __init__(self) -> None:
        self.asked: list[Contest] = []

    def judge(self, asked: Sequence[Contest]) -> Judgements:
        self.asked = list(asked)
        return {}


def judged_moments(
    world: str, overrides: Sequence[str], seed: int, share: float, once: bool = False
) -> list[JudgedMoment]:
    """Drive one episode by the rules; at some open pairs see in a copy what the driver does if the CAV goes on.

    Args:
        share: Of the open pairs of each step, how many are taken, drawn by the seed.
        once: Whether a pair is taken at one step at most.
    """
    config = compose([*overrides, "method=codriving"])
    environment = build(config["environment"], Environment, "environment")
    method = build(config["method"], Method, "method", given={Model: RuleModel(), CaseMemory: None})
    assert isinstance(method, CoDriving)
    judge, rng = _Noting(), np.random.default_rng(seed)
    method.rely_on(judge)
    state = environment.reset(seed)
    method.reset(environment.road_map, environment.driving_model, seed)
    found: list[JudgedMoment] = []
    taken: set[tuple[str, str]] = set()
    while environment.outcome is None:
        judge.asked = []
        deliberation = method.act(state)
        for contest in judge.asked:
            pair = contest.cav, contest.human
            if rng.random() >= share or (once and pair in taken):
                continue
            copied, rules = Copies((environment, method), environment.lasting).another()
            if (yields := lets_pass(copied, rules.act, deliberation, contest)) is not None:
                style = next(t.style for t in environment.trajectory().tracks if t.id == contest.human)
                manner = environment.manners()[contest.human]
                found.append(JudgedMoment(world, seed, state.time, contest, style, manner, yields, None))
                taken.add(pair)
        state = environment.step(deliberation.actions)
    return [replace(one, came=let_pass(entered(environment, one.contest), one.time)) for one in found]


def written_moments(stored: StoredMoments) -> bytes:
    """Write judged moments; the same ones are the same bytes."""
    return written_lines(KIND, stored.about, [{"moment": plain(one)} for one in stored.moments])


def read_moments(file: Path) -> StoredMoments:
    """Read judged moments.

    Raises:
        ConfigError: If the file cannot be read, is of another format, or is not as it was written.
    """
    about, made, found = read_lines(KIND, file, {"moment": JudgedMoment}, BUILDER)
    return StoredMoments(tuple(made), about, found)
