"""What was seen of drivers before, counted by like cases, and a judge that goes by it."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from remembered import frozen, interaction, online
from worlds import Car, Junction, car

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.judgement import Judgement, MetDriver
from codriving.datatypes.parts import CaseMemory, Model, RuleModel
from codriving.datatypes.record import Ending, Outcome
from codriving.errors import ConfigError
from codriving.judgement.contests import Contest, contests
from codriving.judgement.like_cases import CaseObserver, LikeCases
from codriving.judgement.remembered import Remembered
from codriving.methods.codriving import CoDriving

# The CAV has the right of way; both would be at their zone about as soon.
CAV, HUMAN = car("CAV1", "east-west", 80.0, 8.0, 9.0), car("HDV1", "south-north", 76.0, 8.0)


@pytest.fixture(scope="module")
def contest(junction: Junction) -> Contest:
    [found] = contests(junction.thoughts(CAV, HUMAN).moment())
    return found


def met(contest: Contest, yielded: int, went: int, relied: bool | None = None, **numbers: float) -> list[MetDriver]:
    """Drivers in a case like this one, of whom so many let the CAV pass."""
    known, rule = {**contest.numbers, **numbers}, bool(contest.rule) if relied is None else relied
    return [MetDriver("CAV1", f"HDV{k}", k, known, rule, k < yielded) for k in range(yielded + went)]


def judge_of(encounters: Sequence[MetDriver], folder: Path, learns: bool = False, **change: float) -> Remembered:
    """A judge that remembers some drivers, as it is configured but for what is named."""
    path = folder / "m.sqlite"
    memory = online(path)
    memory.begin(interaction())
    memory.learn([], encounters)
    node = {**compose(["judgement=remembered"])["judgement"], **change}
    judge = build(node, Remembered, "judgement")
    if learns:
        memory.begin(interaction(20_001))
    judge.remember(memory if learns else frozen(path))
    return judge


def answer(judge: Remembered, contest: Contest, junction: Junction) -> Judgement:
    judge.reset(junction.road_map, None)
    return judge.judge([contest])["CAV1", "HDV1"]


@pytest.mark.parametrize(
    ("yielded", "went", "expected"),
    [(0, 4, "unclear"), (0, 5, "goes"), (5, 5, "goes"), (11, 7, "unclear"), (17, 1, "unclear"), (18, 0, "yields")],
)
def test_it_says_what_drivers_in_like_cases_did(
    yielded: int, went: int, expected: str, contest: Contest, junction: Junction, tmp_path: Path
) -> None:
    judge = judge_of(met(contest, yielded, went), tmp_path)
    assert judge.drives
    found = answer(judge, contest, junction)
    assert found.answer == expected
    if yielded + went >= 5:
        assert found.yields == pytest.approx((yielded + 1) / (yielded + went + 2), abs=1e-6)
        assert found.reason == f"{yielded} of {yielded + went} drivers met in like cases let the CAV pass"


def test_like_is_who_has_the_right_of_way_who_is_ahead_and_who_stands(contest: Contest) -> None:
    here = replace(contest, numbers={**contest.numbers, "time_ahead": 0.5})
    unlike = [{"priority": -1.0}, {"time_ahead": 1.01}, {"time_ahead": -1.01}, {"human_standing": 1.0}]
    for numbers in unlike:
        others = met(contest, 6, 0, **{"time_ahead": 0.5, **numbers})
        count = LikeCases([*met(contest, 1, 4, time_ahead=-1.0), *others], 5).of(here)
        assert count is not None
        assert (count.yielded, count.all) == (1, 5)


def test_where_few_were_in_a_like_case_all_count_whom_the_rules_hold_back(contest: Contest) -> None:
    others = [*met(contest, 2, 2), *met(contest, 3, 0, priority=0.0), *met(contest, 9, 0, relied=False)]
    count = LikeCases(others, 5).of(contest)
    assert count is not None
    assert (count.yielded, count.all, count.share) == (5, 7, 6 / 9)
    assert LikeCases(others, 8).of(contest) is None


@pytest.mark.parametrize("learns", [True, False])
def test_while_it_learns_the_rules_drive(learns: bool, contest: Contest, junction: Junction, tmp_path: Path) -> None:
    """Else what it has learnt would make itself true."""
    judge = judge_of(met(contest, 0, 9), tmp_path, learns)
    node = compose(["suite=paper"])["method"]
    method = build(node, CoDriving, "method", given={Model: RuleModel(), CaseMemory: judge.memory})
    method.rely_on(judge, memory=judge.memory)
    method.reset(junction.road_map, junction.model, 3)
    assert method.variant == "judgement=remembered"
    first = method.act(junction.world(CAV, HUMAN)).situations[0].order.first_of("CAV1", "HDV1")
    assert first == ("CAV1" if learns else "HDV1")


def seen(junction: Junction, *later: Sequence[Car]) -> list[MetDriver]:
    """What is found of a pair that is judged first, and seen again at later steps."""
    observer = CaseObserver(junction.road_map)
    for k, cars in enumerate([(CAV, HUMAN), *later]):
        moment = junction.thoughts(*cars).moment()
        observer.watch(moment)
        if k == 0:
            observer.note(contests(moment))
            observer.note(contests(moment))
    return observer.found


def at(mine: float, its: float, way: str = "south-west") -> tuple[Car, Car]:
    return car("CAV1", "east-west", mine, 8.0, 9.0), car("HDV1", way, its, 8.0)


def test_a_driver_yields_who_lets_the_cav_be_first(junction: Junction) -> None:
    # The zone begins at 109.4 m for the CAV and at 108.7 m for a driver who turns left.
    assert seen(junction, at(105.0, 90.0)) == []
    [yielded] = seen(junction, at(105.0, 90.0), at(111.0, 95.0), at(115.0, 111.0))
    assert (yielded.yielded, yielded.cav, yielded.human, yielded.step) == (True, "CAV1", "HDV1", 1)
    [went] = seen(junction, at(105.0, 111.0))
    assert not went.yielded


def test_nothing_is_known_of_who_turns_off_or_enters_at_the_same_time(junction: Junction) -> None:
    assert seen(junction, at(112.0, 112.0)) == []
    assert seen(junction, [CAV]) == []
    assert seen(junction, [HUMAN]) == []


def test_what_is_met_is_kept_at_the_end_of_an_episode(junction: Junction, tmp_path: Path) -> None:
    memory = online(tmp_path / "m.sqlite")
    memory.begin(interaction())
    judge = build(compose(["judgement=remembered"])["judgement"], Remembered, "judgement")
    node = compose(["suite=paper"])["method"]
    method = build(node, CoDriving, "method", given={Model: RuleModel(), CaseMemory: memory})
    method.rely_on(judge, memory=memory)
    method.reset(junction.road_map, junction.model, 3)
    for step, cars in enumerate([(CAV, HUMAN), at(111.0, 95.0)]):
        world = junction.world(*cars, time=step / 2, step=step)
        method.act(world)
    counts, _ = method.conclude(world, Outcome(Ending.SUCCESS, 1.0, {}))
    assert counts["encounters"] == 1
    memory.begin(interaction(20_001))
    [kept] = memory.encounters()
    assert (kept.yielded, kept.human) == (True, "HDV1")


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("judgement.fewest=0", "judgement.fewest must be 1 to 1000, got 0"),
        ("judgement.goes_below=0.95", "judgement.goes_below must be at most yields_above, got 0.95, 0.9"),
    ],
)
def test_settings_have_ranges(override: str, message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        build(compose(["judgement=remembered", override])["judgement"], Remembered, "judgement")
