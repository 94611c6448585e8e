"""What judges of human drivers say of judged moments, and what that is worth."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from copy import copy
from dataclasses import dataclass
from typing import Any

from codriving.config import build
from codriving.datatypes import GOES, YIELDS, Judgement, Model, Wrapped
from codriving.environment import Environment
from codriving.errors import ConfigError
from codriving.exam.moments import JudgedMoment
from codriving.experiment import make_objects
from codriving.geometry import RoadMap
from codriving.judgement import Judge, Judging, is_valid
from codriving.llm import Ledger
from codriving.methods import prompted
from codriving.metrics import rate_interval

Roads = Mapping[str, RoadMap]  # By world


@dataclass(frozen=True, slots=True)
class Said:
    """What one judge said of each moment; None where it left a pair out."""

    judgements: tuple[Judgement | None, ...]
    counts: Mapping[str, float]  # Of the model's calls; nothing where none was asked


@dataclass(frozen=True, slots=True)
class Rate:
    """A mean over moments, and its 95 % interval by bootstrap over episodes; None of fewer than ten episodes."""

    mean: float
    interval: tuple[float, float] | None


def roads_of(worlds: Mapping[str, Sequence[str]], compose: Callable[[Sequence[str]], dict[str, Any]]) -> Roads:
    """Build the road of each world."""
    built = {world: build(compose(names)["environment"], Environment, "environment") for world, names in worlds.items()}
    return {world: environment.road_map for world, environment in built.items()}


def ask_judge(config: Mapping[str, Any], moments: Sequence[JudgedMoment], roads: Roads) -> Said:
    """Ask the judge of a config about each moment alone, as ``method=codriving`` would.

    Raises:
        ConfigError: If the config has no judge, or one that has no effect in it.
    """
    objects = make_objects(config)
    method = objects.method
    while isinstance(method, Wrapped):
        method = method.method
    judge = method.judge if isinstance(method, Judging) else None
    if judge is None:
        raise ConfigError(
            "no judge is asked: choose a judgement= other than road_rules (rules_noted is the same), with llm= for a "
            "model, or with memory=frozen and memory.file= for remembered"
        )
    asks = judge.asks_model and objects.llm is not None
    each = [_ready(judge, moment, roads, objects.llm if asks else None, k) for k, moment in enumerate(moments)]
    with ThreadPoolExecutor(objects.llm.max_concurrency if asks and objects.llm is not None else 1) as pool:
        answered = list(pool.map(_ask, each, moments))
    counts: dict[str, float] = {}
    for _, ledger in each:
        for name, number in (ledger.close_step(0.0)[0] if ledger is not None else {}).items():
            counts[name] = counts.get(name, 0) + number
    return Said(tuple(answered), counts)


def _ready(judge: Judge, moment: JudgedMoment, roads: Roads, llm: Model | None, k: int) -> tuple[Judge, Ledger | None]:
    """Give a judge at the beginning of an episode, so that moments know nothing of one another."""
    one, model = copy(judge), prompted(llm, k) if llm is not None else None
    one.reset(roads[moment.world], model)
    one.be_told({moment.contest.human: moment.manner})
    return one, model.ledger if model is not None else None


def _ask(ready: tuple[Judge, Ledger | None], moment: JudgedMoment) -> Judgement | None:
    contest = moment.contest
    judged = ready[0].judge([contest]).get((contest.cav, contest.human))
    return judged if judged is not None and is_valid(judged) else None


def is_open(judged: Judgement | None) -> bool:
    """Whether the rules of the road hold, since it was answered ``unclear`` or not at all."""
    return judged is None or judged.answer not in (YIELDS, GOES)


def is_relied_on(moment: JudgedMoment, judged: Judgement | None) -> bool:
    """Whether the CAV would rely on the driver: by the answer, and by the rules of the road where it is open."""
    if judged is None or is_open(judged):
        return bool(moment.contest.rule)
    return judged.answer == YIELDS


def squared(moment: JudgedMoment, judged: Judgement | None) -> float:
    """Return the squared error of the probability; a pair that was left out counts as a half."""
    return ((0.5 if judged is None else judged.yields) - moment.yields) ** 2


def rate(moments: Sequence[JudgedMoment], numbers: Sequence[float]) -> Rate:
    """Return the mean of a number of each moment, with an interval over episodes."""
    events: dict[int, float] = {}
    units: dict[int, int] = {}
    for moment, number in zip(moments, numbers, strict=True):
        events[moment.seed] = events.get(moment.seed, 0.0) + number
        units[moment.seed] = units.get(moment.seed, 0) + 1
    return Rate(sum(numbers) / len(numbers), rate_interval([*events.values()], [*units.values()]))
