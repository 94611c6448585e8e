"""Sets of suites: what they stand for, and that the worlds of ours are those that were fixed."""

from pathlib import Path

import pytest

from codriving.config.choices import choices, describe
from codriving.config.compose import compose
from codriving.config.suites import changed_worlds, members, sets_scenario, suite_sets, world_hash
from codriving.config.sweep import expand
from codriving.errors import ConfigError

HARD = members("hard")
NAMES = [member.suite for member in HARD]


@pytest.fixture(scope="module")
def hard() -> dict[str, dict[str, object]]:
    return {name: compose([f"suite={name}"]) for name in NAMES}


def test_worlds_of_the_set_are_those_that_were_fixed(hard: dict[str, dict[str, object]]) -> None:
    """A suite that is changed on purpose is fixed anew: its row of hard.csv gets the hash and the date."""
    assert {name: world_hash(config) for name, config in hard.items()} == {m.suite: m.sha256 for m in HARD}
    assert changed_worlds(NAMES, list(hard.values()), None) == []


def test_each_is_one_sentence_that_begins_with_its_name() -> None:
    for name in NAMES:
        sentence = describe(choices("suite")[name])
        assert sentence.startswith(f"{name.replace('_', ' ').capitalize()}: ")
        assert sentence.endswith(".")
        assert "." not in sentence[:-1]


def test_a_changed_world_is_said_to_be_another_one(hard: dict[str, dict[str, object]]) -> None:
    (note,) = changed_worlds(["standoff", None], [compose(["suite=standoff", "scenario.cavs=3"]), hard["crowd"]], None)
    assert note.startswith("suite=standoff is not the world that was fixed for suite=hard on 2026-")


CHANGED = (
    *("v2x=good", "v2x=poor", "v2x=good v2x.loss=0.02", "v2x=good v2x.misbehaviour.ghost=0.1"),
    *("thinking.mind=1.0", "thinking.order=1.0", "thinking.mind=1.0 thinking.order=2.0"),
)


def test_a_channel_and_time_to_think_make_another_world(hard: dict[str, dict[str, object]]) -> None:
    configs = [compose(["suite=crowd", *tokens.split()]) for tokens in CHANGED]
    hashes = {world_hash(config) for config in (hard["crowd"], *configs)}
    assert len(hashes) == 8
    assert world_hash(compose(["suite=slow_mind"])) == world_hash(configs[-1])
    (note,) = changed_worlds(["crowd"] * 7, configs, None)
    assert note.endswith("do not stand beside those of others (SHA-256 " + world_hash(configs[0]) + " and 6 others).")
    # How far CAVs cooperate is of the method, though it stands in this node, too.
    assert changed_worlds(["crowd"], [compose(["suite=crowd", "cda=status_sharing"])], None) == []


def test_a_suite_of_two_sets_is_judged_by_both(tmp_path: Path, hard: dict[str, dict[str, object]]) -> None:
    (tmp_path / "suite").mkdir()
    fixed = next(member.sha256 for member in HARD if member.suite == "standoff")
    for name, digest in (("mine", fixed), ("other", "0"), ("zero", fixed)):
        (tmp_path / "suite" / f"{name}.csv").write_text(f"suite,fixed,sha256\nstandoff,2026-01-01,{digest}\n")
    (note,) = changed_worlds(["standoff"], [hard["standoff"]], tmp_path)
    assert note.startswith("suite=standoff is not the world that was fixed for suite=other on 2026-01-01")


def test_a_set_stands_for_its_suites() -> None:
    assert [point.swept["suite"] for point in expand(["suite=hard"])] == NAMES
    assert [point.overrides for point in expand(["suite=paper,hard"])][:2] == [("suite=paper",), (f"suite={NAMES[0]}",)]


def test_a_set_of_ones_own(tmp_path: Path) -> None:
    (tmp_path / "suite").mkdir()
    (tmp_path / "suite" / "mine.csv").write_text("suite,fixed,sha256\npaper,2026-01-01,0\ncrowd,2026-01-02,1\n")
    assert list(suite_sets(tmp_path)) == ["hard", "mine"]
    assert [point.swept["suite"] for point in expand(["suite=mine"], tmp_path)] == ["paper", "crowd"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("suite,fixed\npaper,2026-01-01\n", "must have the columns suite, fixed, sha256"),
        ("suite,fixed,sha256\n", "must have the columns suite, fixed, sha256"),
        ("suite,fixed,sha256\npaper,2026-01-01\n", "must have the columns suite, fixed, sha256"),
        ("suite,fixed,sha256\nsoft,2026-01-01,0\n", "names the suite 'soft', which there is not; choices: default"),
    ],
)
def test_a_set_that_cannot_be_read_is_refused(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "suite").mkdir()
    (tmp_path / "suite" / "mine.csv").write_text(text)
    with pytest.raises(ConfigError, match=said):
        expand(["suite=mine"], tmp_path)


def test_where_one_suite_is_asked_for_a_set_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"suite=hard is a set of suites, hard\.csv, and one is asked for here; name"):
        compose(["suite=hard"])
    with pytest.raises(ConfigError, match=r"unknown suite 'har'; choices: default, paper, .*, hard$"):
        compose(["suite=har"])


def test_another_scenario_than_the_suites_is_refused() -> None:
    with pytest.raises(ConfigError, match="suite=standoff is about scenario=intersection; leave scenario=merge out"):
        compose(["suite=standoff", "scenario=merge"])
    assert compose(["suite=paper", "scenario=merge"])["scenario"]["ramp_hdvs"] == 0.3


@pytest.mark.parametrize(
    ("tokens", "sets"),
    [
        (["suite=hard"], True),
        (["suite=paper,standoff"], True),
        (["+suite=standoff"], True),
        (["suite=paper"], False),
        (["episodes=3"], False),
        (["suite=typo"], False),
    ],
)
def test_whether_a_suite_chooses_a_scenario(tokens: list[str], sets: bool) -> None:
    assert sets_scenario(tokens) is sets
