"""The non-cooperative game: dominance, symmetry, best responses, and numbers that are always defined."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from seeing import Seen, decide, game, seen
from worlds import Junction, car

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.methods.noncoop_game.games import ACCELERATIONS, CHANGE, PassingGame, lane_game, passing_game
from codriving.methods.noncoop_game.payoff import pure_equilibria
from codriving.methods.single_vehicle.encounters import Encounter
from codriving.methods.single_vehicle.lane_choice import look

LEGS = ("south", "west", "north", "east")
ROUTES = tuple(f"{a}-{b}" for a in LEGS for b in LEGS if a != b)


def partner(view: Seen) -> list[Encounter]:
    """Where the CAV meets its most critical partner."""
    met = game().others.met(*view)
    return [e for e in met if e.conflict.other == met[0].conflict.other]


def played(view: Seen) -> PassingGame:
    driver = game()
    return passing_game(
        partner(view), view[0].scenes[view[1]].ego.speed, view[0].forecast.model.top_speed, driver.hold, driver.times
    )


def test_a_partner_far_away_does_not_keep_it_from_accelerating(junction: Junction) -> None:
    ego, far = car("CAV1", "south-north", 95.0, 6.0), car("HDV1", "west-east", 76.0, 5.0)
    choice = decide(game(), junction, ego, far)
    assert choice.counts["games"] == 1
    assert choice.action is Action.FASTER
    driver = game()
    acceleration, said, precedence = driver.play(*seen(junction, ego, far), partner(seen(junction, ego, far)))
    assert (acceleration, precedence.first) == (2.0, "CAV1")
    assert said.startswith("the game with HDV1")


def test_it_lets_a_partner_pass_who_is_there_first(junction: Junction) -> None:
    ego, near = car("CAV1", "south-north", 88.0, 7.0), car("HDV1", "west-east", 98.0, 7.0)
    driver, view = game(), seen(junction, ego, near)
    acceleration, _, precedence = driver.play(*view, partner(view))
    assert acceleration < 0
    assert precedence.first == "HDV1"


def test_a_symmetric_meeting_has_two_asymmetric_equilibria(junction: Junction) -> None:
    view = seen(junction, car("CAV1", "south-north", 86.0, 7.0), car("CAV2", "west-east", 90.0, 7.0))
    (e,) = [e for e in partner(view) if e.conflict.routes[1] == "west-east"]
    assert e.own_way == pytest.approx(e.its_way, abs=0.6)
    driver = game()
    made = passing_game([e], 7.0, view[0].forecast.model.top_speed, driver.hold, driver.times)
    found = pure_equilibria(made.own(driver.own), made.other(driver.own))
    firsts = {bool(made.own_first[pair]) for pair in found}
    assert firsts == {True, False}, "one in which each goes first"
    assert all(row != column for row, column in found)


def test_of_two_who_meet_at_once_not_both_accelerate(junction: Junction) -> None:
    cars = (car("CAV1", "south-north", 86.0, 7.0, 7.0), car("CAV2", "west-east", 90.0, 7.0, 7.0))
    actions = {ego: decide(game(), junction, *cars, ego=ego).action for ego in ("CAV1", "CAV2")}
    assert Action.SLOWER in actions.values()


ways = st.tuples(st.sampled_from(ROUTES), st.floats(60.0, 118.0), st.floats(0.0, 9.0))


@settings(max_examples=25, deadline=None)
@given(ways, ways)
def test_payoffs_are_defined_and_the_answer_is_a_best_response(
    junction: Junction, one: tuple[str, float, float], other: tuple[str, float, float]
) -> None:
    view = seen(junction, car("CAV1", *one), car("CAV2", *other))
    assume(view[0].conflicts["CAV1"])
    driver, made = game(), played(view)
    own = made.own(driver.own)
    assert np.isfinite(own).all()
    assert (made.gaps >= 0).all()
    for first in (True, False):
        answers = driver.answers(made, first)
        for temper, answer in zip(driver.tempers, answers, strict=True):
            its = made.other(temper)
            assert np.isfinite(its).all()
            stable = {column for _, column in pure_equilibria(own, its)}
            assert answer in (stable or {int(np.argmax(its.min(axis=0)))})
    acceleration, _, _ = driver.play(*view, partner(view))
    assert acceleration in ACCELERATIONS


@pytest.mark.parametrize("speeds", [(0.0, 0.0), (0.0, 9.0), (9.0, 0.0)])
def test_at_rest_every_number_is_defined(speeds: tuple[float, float], junction: Junction) -> None:
    view = seen(junction, car("CAV1", "south-north", 99.0, speeds[0]), car("CAV2", "west-east", 97.0, speeds[1]))
    made = played(view)
    assert np.isfinite(made.progress).all()
    assert not np.isnan(made.gaps).any()
    assert np.isfinite(made.own(game().own)).all()


def test_danger_lowers_the_payoff_and_progress_raises_it() -> None:
    temper = game().own
    calm, none = np.zeros((1, 1)), np.zeros((1, 1), dtype=np.bool_)

    def worth(progress: float, gap: float, crash: bool = False) -> float:
        return float(temper.payoff(calm + progress, calm, calm + gap, none | crash)[0, 0])

    assert worth(0.5, 1.0) < worth(0.5, 2.0) < worth(0.6, 2.0)
    assert worth(0.5, 1.0, True) == pytest.approx(worth(0.5, 1.0) - 10.0)


def test_a_lane_change_before_a_vehicle_that_would_have_to_brake_hard_is_refused(highway: Junction) -> None:
    lanes = sorted(highway.road_map.routes)
    ego = car("CAV1", lanes[1], 100.0, 15.0)
    slow = car("HDV1", lanes[1], 118.0, 10.0)
    driver = game()

    def refused(gap: float, speed: float) -> str:
        view = seen(highway, ego, slow, car("HDV2", lanes[0], 100.0 - gap - 5.0, speed))
        side = look(*view, Action.LANE_LEFT, 8.0)
        assert side is not None
        assert side.behind is not None
        made = lane_game(*view, side, driver.others.idm, driver.hold, driver.times)
        assert np.isfinite(made.own(driver.own)).all()
        assert np.isfinite(made.other(driver.own)).all()
        assert made.own(driver.own).shape == (CHANGE + 1, 2)
        return driver.refuses(*view, side, driver.others.idm)

    assert refused(60.0, 15.0) == ""
    assert "the game with HDV2" in refused(6.0, 25.0)


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ("own=brave", "own must be one of aggressive, normal, conservative, got brave"),
        ("tempers.normal.share=0.5", "tempers: their shares must add up to 1, got 1.09"),
        ("tempers.normal.risk_time=0", "risk_time must be 0.05 to 20 s, got 0"),
        ("tempers.normal.safety=-1", "safety must be 0 to 100, got -1"),
        ("tempers.normal.share=2", "share must be 0 to 1, got 2"),
        ("hold=4", "hold must be 0.1 to 3, got 4"),
        ("horizon=0.5", "horizon must be 1 to 10, got 0.5"),
        ("sample=2", "sample must be 0.05 to 1, got 2"),
        ("indifference=-1", "indifference must be 0 to 100, got -1"),
        ("others.lanes.politeness=2", "politeness must be 0 to 1, got 2"),
    ],
)
def test_settings_out_of_range_are_refused(key: str, said: str) -> None:
    node = compose(["method=noncoop_game"])["method"]
    (*groups, last), value = key.split("=")[0].split("."), key.split("=")[1]
    inner = node["driver"]
    for group in groups:
        inner = inner[group]
    inner[last] = value if last == "own" else float(value)
    with pytest.raises(ConfigError, match=said):
        build(node, object)
