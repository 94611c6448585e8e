"""Who wants to come in when: how many, how far apart, and that nothing else has a say in it."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from streets import Streets, parallel

from codriving.datatypes.flow import Flow
from codriving.datatypes.world import Kind
from codriving.environment.arrivals import Newcomer, draw_newcomers, entries

FLOW = Flow(arrivals=600.0, share=0.5, headway=2.0, warm_up=100.0, window=500.0)

FINE = 1e-6  # Times are hardly rounded with it [s]


def streets(number: int) -> Streets:
    return Streets(parallel(number))


def of(newcomers: tuple[Newcomer, ...], number: int) -> list[Newcomer]:
    return [n for n in newcomers if n.lane == (f"a{number}", f"b{number}", 0)]


def test_lanes_that_lead_in_and_the_routes_that_begin_there() -> None:
    assert entries(streets(2)) == {("a0", "b0", 0): ("r0", "near"), ("a1", "b1", 0): ("r1",)}


def test_as_many_as_asked_for_arrive_and_none_sooner_than_the_headway() -> None:
    """600 an hour are 100 in 600 s; gaps are 2 s and an exponential rest with a mean and a deviation of 4 s."""
    drawn = [of(draw_newcomers(streets(1), FLOW, seed, FINE), 0) for seed in range(10_000, 10_100)]
    assert np.mean([len(one) for one in drawn]) == pytest.approx(100, abs=2.5)
    gaps = np.concatenate([np.diff([n.time for n in one]) for one in drawn])
    assert gaps.min() >= 2 - 2 * FINE
    assert gaps.mean() == pytest.approx(6, abs=0.2)
    assert gaps.std() == pytest.approx(4, abs=0.2)
    # Of an exponential rest, the share exp(-1) is longer than its mean.
    assert (gaps > 6).mean() == pytest.approx(0.368, abs=0.02)


def test_it_is_as_if_the_flow_had_begun_long_before() -> None:
    """In the first 10 s there are 10 / 6 arrivals on average, no fewer; with whole gaps from 0 on there are 1.28."""
    short = replace(FLOW, warm_up=0.0, window=10.0)
    counts = [len(draw_newcomers(streets(1), short, seed, FINE)) for seed in range(10_000, 13_000)]
    assert np.mean(counts) == pytest.approx(10 / 6, abs=0.06)


def test_the_same_seed_gives_the_same_and_another_one_others() -> None:
    assert draw_newcomers(streets(2), FLOW, 10_000, 0.5) == draw_newcomers(streets(2), FLOW, 10_000, 0.5)
    assert draw_newcomers(streets(2), FLOW, 10_000, 0.5) != draw_newcomers(streets(2), FLOW, 10_001, 0.5)


def test_one_lane_does_not_change_the_others() -> None:
    two, three = (draw_newcomers(streets(number), FLOW, 10_000, 0.5) for number in (2, 3))
    assert of(two, 0) == of(three, 0)
    assert of(two, 1) == of(three, 1)
    assert [n.time for n in of(two, 0)] != [n.time for n in of(two, 1)]


def test_the_share_of_cavs_changes_nothing_but_who_drives() -> None:
    few, many = (draw_newcomers(streets(2), replace(FLOW, share=share), 10_000, 0.5) for share in (0.2, 0.8))
    assert [(n.time, n.start.route, n.start.speed) for n in few] == [
        (n.time, n.start.route, n.start.speed) for n in many
    ]
    kinds = Counter((a.start.kind, b.start.kind) for a, b in zip(few, many, strict=True))
    assert (Kind.CAV, Kind.HDV) not in kinds, "a CAV stays one where there are more of them"
    assert kinds[Kind.HDV, Kind.CAV] / len(few) == pytest.approx(0.6, abs=0.15)
    assert {n.start.kind for n in draw_newcomers(streets(1), replace(FLOW, share=1.0), 10_000, 0.5)} == {Kind.CAV}
    assert {n.start.kind for n in draw_newcomers(streets(1), replace(FLOW, share=0.0), 10_000, 0.5)} == {Kind.HDV}


def test_both_goals_of_a_lane_are_drawn_alike() -> None:
    drawn = [n for seed in range(10_000, 10_010) for n in draw_newcomers(streets(1), FLOW, seed, 0.5)]
    assert Counter(n.start.route for n in drawn)["near"] / len(drawn) == pytest.approx(0.5, abs=0.06)


def test_times_are_rounded_up_to_the_decisions_and_names_tell_vehicles_apart() -> None:
    fine, rough = (draw_newcomers(streets(30), FLOW, 10_000, interval) for interval in (FINE, 0.5))
    exact = {n.start.id: n.time for n in fine}
    assert all(0 <= n.time - exact[n.start.id] < 0.5 and (n.time / 0.5).is_integer() for n in rough)
    plain = [n.start.id.removeprefix("CAV").removeprefix("HDV") for n in rough]
    assert len(set(plain)) == len(plain), "also without who drives"
    assert of(rough, 0)[0].start.id in ("CAV1a", "HDV1a")
    assert of(rough, 27)[1].start.id in ("CAV2ab", "HDV2ab")
