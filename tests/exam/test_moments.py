"""Judged moments: drawn by the seed, without a trace in the episode, and what judges say of them."""

from dataclasses import replace
from pathlib import Path

import pytest
from source import REPOSITORY

from codriving.config.compose import compose
from codriving.errors import ConfigError
from codriving.exam.judges import ask_judge, is_relied_on, rate, roads_of, squared
from codriving.exam.moments import (
    SEEDS,
    WORLDS,
    JudgedMoment,
    StoredMoments,
    judged_moments,
    read_moments,
    written_moments,
)
from codriving.exam.plain import plain

WORLD = {"short": ("suite=standoff", "scenario.time_limit=14")}
SEED = 20_002
ROADS = roads_of(WORLD, compose)


@pytest.fixture(scope="module")
def moments() -> list[JudgedMoment]:
    """All of an episode in which most drivers let the CAV pass, and one does not."""
    return judged_moments("short", WORLD["short"], SEED, 1.0)


def test_what_drivers_do_is_told(moments: list[JudgedMoment]) -> None:
    assert {one.yields for one in moments} == {True, False}
    assert {one.style for one in moments} == {"attentive", "distracted"}
    assert {one.seed for one in moments} == {SEED}
    assert all(one.time < 14.0 for one in moments)


def test_moments_are_drawn_by_the_seed_and_looking_on_leaves_the_episode_as_it_is(moments: list[JudgedMoment]) -> None:
    told = {(one.time, one.contest.cav, one.contest.human): plain(one) for one in moments}
    few = judged_moments("short", WORLD["short"], SEED, 0.4)
    assert 0 < len(few) < len(moments)
    assert all(plain(one) == told[one.time, one.contest.cav, one.contest.human] for one in few)
    once = judged_moments("short", WORLD["short"], SEED, 0.4, once=True)
    pairs = [(one.contest.cav, one.contest.human) for one in once]
    assert len(set(pairs)) == len(pairs) < len(few)
    assert all(plain(one) in map(plain, few) for one in once)


def test_moments_come_back_from_their_file(moments: list[JudgedMoment], tmp_path: Path) -> None:
    (file := tmp_path / "m.xz").write_bytes(written_moments(StoredMoments(tuple(moments), {"seeds": "20000"})))
    stored = read_moments(file)
    assert plain(stored.moments) == plain(moments)
    assert written_moments(stored) == file.read_bytes()
    file.write_bytes(b"")
    with pytest.raises(ConfigError, match=r"m.xz cannot be read .*docs/judgement/moments.py"):
        read_moments(file)


def test_ours_are_of_seeds_of_their_own_and_come_out_of_the_world_again() -> None:
    ours = read_moments(REPOSITORY / "docs" / "judgement" / "moments.jsonl.xz")
    page = (REPOSITORY / "docs" / "judgement.md").read_text(encoding="utf-8")
    assert ours.sha256[:12] in page
    assert f"holds {len(ours.moments)} of them" in page
    assert len(ours.moments) >= 400
    part, names = len(SEEDS) // len(WORLDS), list(WORLDS)
    assert all(one.seed in SEEDS and names[(one.seed - SEEDS.start) // part] == one.world for one in ours.moments)
    pairs = [(one.seed, one.contest.cav, one.contest.human) for one in ours.moments]
    assert len(set(pairs)) == len(pairs)
    seed = next(one.seed for one in ours.moments if one.world == "merge, mixed")
    again = judged_moments("merge, mixed", WORLDS["merge, mixed"], seed, 0.15, once=True)
    assert plain(again) == plain([one for one in ours.moments if one.seed == seed])


def test_each_world_has_seeds_of_its_own() -> None:
    assert len(SEEDS) % len(WORLDS) == 0
    assert len({tuple(names) for names in WORLDS.values()}) == len(WORLDS) == 12


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["judgement=never"], lambda one: 0.0),
        (["judgement=always"], lambda one: 1.0),
        (["judgement=rules_noted"], lambda one: float(bool(one.contest.rule))),
        (["judgement=llm", "llm=first"], lambda one: 0.0),
    ],
)
def test_what_judges_say(words: list[str], says: object, moments: list[JudgedMoment]) -> None:
    said = ask_judge(compose(["method=codriving", *words]), moments, ROADS)
    assert [None if j is None else j.yields for j in said.judgements] == [says(one) for one in moments]  # type: ignore[operator]
    assert bool(said.counts) == ("llm=first" in words)


def test_an_oracle_is_told_how_each_driver_drives(moments: list[JudgedMoment]) -> None:
    def says(one: JudgedMoment) -> float:
        [judged] = ask_judge(compose(["method=codriving", "judgement=oracle"]), [one], ROADS).judgements
        assert judged is not None
        return judged.yields

    manners = [replace(moments[0].manner, gives_way=way) for way in ("by_rule", "never")]
    crossing = [one for one in moments if one.contest.rule]
    answers = {tuple(says(replace(one, manner=manner)) for manner in manners) for one in crossing}
    assert (1.0, 0.0) in answers


@pytest.mark.parametrize("words", [["judgement=road_rules"], ["judgement=remembered"], ["judgement=llm"]])
def test_who_cannot_be_asked_is_refused(words: list[str], moments: list[JudgedMoment]) -> None:
    with pytest.raises(ConfigError, match="no judge is asked: choose a judgement= other than road_rules"):
        ask_judge(compose(["method=codriving", *words]), moments, ROADS)


def test_an_open_answer_is_left_to_the_rules_and_a_pair_left_out_is_a_half(moments: list[JudgedMoment]) -> None:
    one = replace(moments[0], yields=True)
    for rule in ("", "it stands"):
        moment = replace(one, contest=replace(one.contest, rule=rule))
        assert is_relied_on(moment, None) is bool(rule)
        assert squared(moment, None) == 0.25


def test_a_rate_is_over_moments_and_its_interval_over_episodes(moments: list[JudgedMoment]) -> None:
    several = [replace(moments[0], seed=k // 2) for k in range(40)]
    alike = rate(several, [float(k // 2 % 2) for k in range(40)])
    apart = rate(several, [float(k % 2) for k in range(40)])
    assert (alike.mean, apart.mean) == (0.5, 0.5)
    assert apart.interval == (0.5, 0.5)
    assert alike.interval is not None
    assert alike.interval[0] == pytest.approx(0.5 - 1.96 * 0.5 / 20**0.5, abs=0.06)
    assert rate(several[:10], [1.0] * 10).interval is None
