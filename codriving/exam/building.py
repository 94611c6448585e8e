"""Builds an exam: drives episodes by the rules, stops at moments drawn by the seed, and judges what can be answered."""

import json
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from copy import deepcopy
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from codriving.briefing import nothing_to_judge
from codriving.config import compose, members
from codriving.datatypes import Method, Situation, WorldState
from codriving.environment import Environment
from codriving.exam.driving_on import DRAWS, HELD, HORIZON, Copied
from codriving.exam.observed import Posed, notebook_of
from codriving.exam.plain import plain, restored
from codriving.exam.stored import Consequence, ExamNegotiation, ExamSituation, Origin, PairInQuestion, StoredExam
from codriving.experiment import make_objects
from codriving.judgement import contests
from codriving.reasoning import Moment, is_plain
from codriving.runs import BEHAVIOUR, write_text

FIRST, SEEDS = 28_000, 70  # Seeds of the first world begin here; so many lie between those of two worlds
LAST = 28_999  # No seed of an exam is above this

SITUATIONS, NEGOTIATIONS = 31, 10  # Of each world at most

OF_AN_EPISODE = (3, 1)  # Situations and negotiations at most

CHANCE = 0.25  # With which a step of an episode is taken

SETTLED = 1.0  # Nothing is asked before this time of an episode [s]

PAIRS, DRIVERS = 2, 2  # Of one question, judged at most


def worlds() -> dict[str, tuple[str, ...]]:
    """Return the worlds by name: the scenarios as they are, and the members of the hard suite.

    The intersection as it is has the name that it has in the suite.
    """
    plainly = {name: (f"scenario={name}",) for name in ("roundabout", "highway", "merge")}
    return {**plainly, **{member.suite: (f"suite={member.suite}",) for member in members("hard")}}


@dataclass
class Observers:
    """Shows the world to several methods."""

    methods: Sequence[Method]

    def __call__(self, world: WorldState) -> None:
        """Show it to those that want to see it."""
        for method in self.methods:
            if method.observer is not None:
                method.observer(world)


@lru_cache(maxsize=1)
def _objects(overrides: tuple[str, ...]) -> tuple[Environment, tuple[Method, Method]]:
    """Build a world, and what drives it on: the rules, and the planned executor by the best order."""
    rules, plans = compose([*overrides]), compose([*overrides, "order=optimal"])
    rules["method"]["_target_"] = "codriving.exam.observed.Examined"
    given = {"rule": plans["order"], "executor": plans["executor"], "judgement": plans["judgement"]}
    plans["method"] = {"_target_": "codriving.exam.observed.ExaminedPlans", **given}
    found = [make_objects(config) for config in (rules, plans)]
    for each in found:
        notebook_of(each.method)
    environment, both = found[0].environment, (found[0].method, found[1].method)
    assert isinstance(environment, Environment)
    environment.observer = Observers(both)
    return environment, both


@dataclass
class Episode:
    """What was taken of one episode."""

    situations: list[ExamSituation] = field(default_factory=list)
    negotiations: list[ExamNegotiation] = field(default_factory=list)


def take(world: str, overrides: tuple[str, ...], seed: int) -> Episode:
    """Drive one episode by the rules, and take questions of it."""
    environment, methods = _objects(overrides)
    state, rng, found = environment.reset(seed), np.random.default_rng((seed, 7)), Episode()
    for method in methods:
        method.reset(environment.road_map, environment.driving_model, seed)
    notebook = notebook_of(methods[0])
    while environment.outcome is None:
        notebook.empty()
        notebook.closed = False
        drawn = rng.random(3)
        wanted = SETTLED <= state.time < environment.scenario.pace.time_limit - HORIZON and drawn[0] < CHANCE
        wanted = wanted and (len(found.situations), len(found.negotiations)) != OF_AN_EPISODE
        before = deepcopy(methods, {id(part): part for part in environment.lasting}) if wanted else ()
        actions = methods[0].act(state).actions
        methods[1].act(state)
        if wanted:
            copied = Copied(environment, before, state, seed)
            origin = Origin(world, overrides, seed, state.step, "")
            asked, posed = list(notebook.situations), list(notebook.posed)
            if len(found.situations) < OF_AN_EPISODE[0]:
                found.situations += _situations(asked, copied, origin, drawn[1])
            if len(found.negotiations) < OF_AN_EPISODE[1]:
                found.negotiations += _negotiations(posed, copied, origin, drawn[2])
        state = environment.step(actions)
    return found


def _situations(
    asked: Sequence[tuple[Situation, Moment | None]], copied: Copied, origin: Origin, drawn: float
) -> Iterator[ExamSituation]:
    """Judge one of the situations in which a model would be asked, if its answers differ."""
    open_ones = [
        (s, m) for s, m in asked if m is not None and not is_plain(s, m.sees_conflicts) and not nothing_to_judge(s)
    ]
    if not open_ones:
        return
    situation, moment = open_ones[int(drawn * len(open_ones))]
    ego = situation.scene.ego.id
    if not _differ(copied.of_actions(situation, quick=True).values()):
        return
    judged = copied.of_actions(situation)
    if not _differ(judged.values()):
        return
    mine = [c for c in contests(moment) if c.cav == ego][:DRIVERS]
    truths = [(contest, passed) for contest in mine if (passed := copied.lets_pass(contest)) is not None]
    name = f"{origin.world}-{origin.seed}-{origin.step}-{ego}"
    told, yields = tuple(contest for contest, _ in truths), tuple(passed for _, passed in truths)
    yield ExamSituation(name, replace(origin, ego=ego), situation, judged, told, yields)


def _negotiations(posed: Sequence[Posed], copied: Copied, origin: Origin, drawn: float) -> Iterator[ExamNegotiation]:
    """Judge one of the negotiations of a step, if it makes a difference who goes first."""
    if not posed:
        return
    one, pairs = posed[int(drawn * len(posed))], []
    for c in sorted(one.conflicts, key=lambda c: (c.dttcp + 0.2 * min(c.ttcp), c.ego, c.other))[:PAIRS]:
        pair = c.ego, c.other
        if not _differ(copied.of_orders(pair, quick=True)):
            continue
        both = copied.of_orders(pair)
        if _differ(both) and (first := one.order.first_of(*pair)) is not None:
            pairs.append(PairInQuestion(*pair, first, *both))
    if pairs:
        name = f"{origin.world}-{origin.seed}-{origin.step}-order"
        yield ExamNegotiation(name, origin, one.scenes, one.problem, one.conflicts, one.previous, tuple(pairs))


def _differ(answers: Iterable[Consequence]) -> bool:
    """Whether some answers are acceptable, and some are not; else nothing can be learnt of who is asked."""
    return len({answer.acceptable for answer in answers}) == 2


def _kept(work: Path, world: str, overrides: tuple[str, ...], seed: int) -> Path:
    """Take questions of an episode, if its file is not there yet."""
    file = work / f"{world}-{seed}.json"
    if not file.exists():
        found = take(world, overrides, seed)
        write_text(file, json.dumps(plain(found)))
    return file


def build_exam(
    work: Path,
    episodes: int,
    workers: int = 1,
    named: Collection[str] = (),
    about: Mapping[str, str] = {},
    tell: Callable[[str], None] = print,
) -> StoredExam:
    """Take questions of so many episodes of each world at most, fewer where there are enough before.

    Args:
        work: Folder in which what was taken of each episode is kept; what is there is not driven again.
        named: Worlds that are taken; empty for all.
    """
    work.mkdir(parents=True, exist_ok=True)
    every = list(worlds())
    found = {world: Episode() for world in every if world in (named or every)}
    with ProcessPoolExecutor(workers) as pool:
        for k in range(min(episodes, SEEDS)):
            wanting = [world for world, of in found.items() if not _enough(of, k)]
            places = [(worlds()[w], FIRST + SEEDS * every.index(w) + k) for w in wanting]
            files = pool.map(_kept, [work] * len(wanting), wanting, *zip(*places, strict=True)) if wanting else ()
            for world, file in zip(wanting, files, strict=True):
                of = restored(Episode, json.loads(file.read_text(encoding="utf-8")))
                found[world].situations += of.situations
                found[world].negotiations += of.negotiations
            told = sum(len(of.situations) for of in found.values()), sum(len(of.negotiations) for of in found.values())
            tell(f"{k + 1} episodes of each world: {told[0]} situations, {told[1]} negotiations")
    settings = {
        "behaviour": str(BEHAVIOUR),
        "seeds": f"{FIRST} to {FIRST + SEEDS * len(every) - 1}, {episodes} at most of each of {len(found)} worlds",
        "judged": f"{DRAWS} draws of drivers, rules and planned executor, {HORIZON:g} s on, actions for {HELD} steps",
    }
    situations = tuple(one for of in found.values() for one in of.situations[:SITUATIONS])
    negotiations = tuple(one for of in found.values() for one in of.negotiations[:NEGOTIATIONS])
    return StoredExam(situations, negotiations, {**about, **settings})


def _enough(of: Episode, driven: int) -> bool:
    """Whether a world has given its share; where CAVs do not negotiate that is not waited for."""
    full = len(of.negotiations) >= NEGOTIATIONS or (driven >= SEEDS // 3 and not of.negotiations)
    return len(of.situations) >= SITUATIONS and full
