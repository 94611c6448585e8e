"""Judges that are one rule each, on both sides of their thresholds."""

from collections.abc import Mapping
from dataclasses import replace

import pytest
from worlds import Junction, car

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.judgement import Judgement
from codriving.datatypes.world import Manner
from codriving.errors import ConfigError
from codriving.judgement.contests import Contest, contests
from codriving.judgement.judge import Judge
from codriving.judgement.rules import Earliest


@pytest.fixture(scope="module")
def contest(junction: Junction) -> Contest:
    """A driver who has to give way, and a CAV with the right of way."""
    world = junction.world(car("CAV1", "east-west", 80.0, 8.0, 9.0), car("HDV1", "south-north", 76.0, 8.0))
    [found] = contests(junction.think(world).moment())
    return found


def told(contest: Contest, **numbers: float) -> Contest:
    """The same pair with other numbers."""
    return replace(contest, numbers={**contest.numbers, **numbers})


def answer(judge: Judge, contest: Contest) -> Judgement:
    """What is said of one pair."""
    return judge.judge([contest])["CAV1", "HDV1"]


@pytest.mark.parametrize(
    ("numbers", "expected"),
    [
        ({"time_ahead": 1.01, "human_standing": 0.0, "priority": 1.0}, ("yields", 1.0)),
        ({"time_ahead": 0.99, "human_standing": 0.0, "priority": 1.0}, ("goes", 0.0)),
        ({"time_ahead": 1.01, "human_standing": 0.0, "priority": -1.0}, ("unclear", 0.5)),
        ({"time_ahead": -5.0, "human_standing": 2.0, "priority": -1.0}, ("yields", 1.0)),
        ({"time_ahead": -5.0, "human_standing": 1.9, "priority": -1.0}, ("goes", 0.0)),
    ],
)
def test_earliest(numbers: Mapping[str, float], expected: tuple[str, float], contest: Contest) -> None:
    found = answer(Earliest(1.0, 2.0, False), told(contest, **numbers))
    assert (found.answer, found.yields) == expected
    assert found.reason


def test_earliest_may_rely_on_those_who_have_the_right_of_way(contest: Contest) -> None:
    assert answer(Earliest(1.0, 2.0, True), told(contest, time_ahead=1.01, priority=-1.0)).answer == "yields"


def test_its_times_have_a_range() -> None:
    with pytest.raises(ConfigError, match="lead must be -5 to 10 s, got 11"):
        Earliest(11.0, 2.0, False)


@pytest.mark.parametrize(
    ("name", "rule", "expected"),
    [
        ("rules_noted", "it has to wait", "yields"),
        ("rules_noted", "", "goes"),
        ("never", "it has to wait", "goes"),
        ("always", "", "yields"),
    ],
)
def test_others(name: str, rule: str, expected: str, contest: Contest) -> None:
    judge = build(compose([f"judgement={name}"])["judgement"], Judge, "judgement")
    assert answer(judge, replace(contest, rule=rule)).answer == expected


def test_the_oracle_knows_who_never_gives_way(contest: Contest, junction: Junction) -> None:
    judge = build(compose(["judgement=oracle"])["judgement"], Judge, "judgement")
    judge.reset(junction.road_map, None)
    assert judge.judge([contest]) == {}
    for gives_way, expected in (("by_rule", "yields"), ("never", "goes")):
        judge.be_told({"HDV1": Manner(gives_way, False, 0.8)})
        assert answer(judge, contest).answer == expected
