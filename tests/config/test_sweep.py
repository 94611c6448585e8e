"""Several values of a key become several configs; what only looks like several stays one."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.config.overrides import parse
from codriving.config.schema import ROOT
from codriving.config.sweep import MOST, ONE_VALUE, Point, expand
from codriving.errors import ConfigError


def values(token: str, config_dir: Path | None = None) -> list[str]:
    """The values that one token stands for."""
    key = token.partition("=")[0].lstrip("+")
    return [point.swept[key] for point in expand([token], config_dir)]


def refused(*tokens: str, config_dir: Path | None = None) -> str:
    with pytest.raises(ConfigError) as err:
        expand(tokens, config_dir)
    assert "\n" not in str(err.value)
    return str(err.value)


@pytest.mark.parametrize(
    "tokens",
    [
        [],
        ["scenario=intersection", "episodes=3"],
        ["scenario.target_speeds=[0,3,6]"],
        ["output='a,b'"],
        ['output="a,b"'],
        ["scenario.x={a:1,b:2}"],
        ["scenario.x=choice(1)"],
        ["scenario.x=1,1"],
        ["run=all"],
    ],
)
def test_one_value_is_one_config_and_no_sweep(tokens: list[str]) -> None:
    (point,) = expand(tokens)
    assert point.swept == {}


def test_a_token_with_one_value_stays_as_typed() -> None:
    tokens = ("+scenario=intersection", "output='a,b'", "~episodes", "hydra.verbose=a,b", "scenario@x=a,b")
    assert expand(tokens) == (Point(tokens),)


@pytest.mark.parametrize(
    ("token", "expected"),
    [
        ("scenario.cavs=4,8", ["4", "8"]),
        ("scenario.cavs=8,4,8", ["8", "4"]),
        ("++scenario.cavs=4,8", ["4", "8"]),
        ("scenario.cavs=choice(4,8)", ["4", "8"]),
        ("scenario.cavs=range(2,9,3)", ["2", "5", "8"]),
        ("method.margin=range(1.0,2.0,0.5)", ["1.0", "1.5"]),
        ("method.margin=sort(2,1)", ["1", "2"]),
        ("scenario.hdvs=[0,0],[2,4]", ["[0,0]", "[2,4]"]),
        ("a.b=true,False,null", ["true", "false", "null"]),
        ("a.b='x,y',z", ["'x,y'", "z"]),
        ("a.b=${c},d", ["${c}", "d"]),
        ("cda='full',prescriptive", ["full", "prescriptive"]),
        ("metrics=authors,standard", ["authors", "standard"]),
        ("metrics=glob(a*)", None),
        ("cda=glob(*,exclude=*sharing)", ["full", "agreement_seeking", "prescriptive"]),
    ],
)
def test_several_values_in_the_order_given(token: str, expected: list[str] | None) -> None:
    assert (values(token) if expected else [dict(point.swept) for point in expand([token])]) == (expected or [{}])


def test_the_first_key_varies_slowest_and_other_tokens_stay_in_place() -> None:
    points = expand(["cda=full,prescriptive", "episodes=3", "scenario.cavs=4,8"])
    assert [tuple(point.swept.values()) for point in points] == [
        ("full", "4"),
        ("full", "8"),
        ("prescriptive", "4"),
        ("prescriptive", "8"),
    ]
    assert points[1].overrides == ("cda=full", "episodes=3", "scenario.cavs=8")


@settings(deadline=None)
@given(st.lists(st.one_of(st.integers(), st.text("ab',[]{}:= ", min_size=1)), min_size=2, max_size=6, unique=True))
def test_a_value_of_a_sweep_means_what_it_means_alone(given: list[int | str]) -> None:
    def typed(value: int | str) -> str:
        return str(value) if isinstance(value, int) else "'" + value.replace("'", "\\'") + "'"

    points = expand([f"a.b={','.join(map(typed, given))}"])
    assert [parse(override).value() for point in points for override in point.overrides] == given


def test_all_is_every_choice_in_the_order_of_the_list() -> None:
    assert values("scenario=all") == list(choices("scenario"))
    assert values("cda=all") == ["status_sharing", "intent_sharing", "full", "agreement_seeking", "prescriptive"]
    assert values("cda=prescriptive,all")[:2] == ["prescriptive", "status_sharing"]
    assert len(values("cda=prescriptive,all")) == 5


def test_the_papers_scenarios_come_first_and_a_users_by_name(tmp_path: Path) -> None:
    (tmp_path / "scenario").mkdir()
    for name in ("zoo", "a_junction"):
        (tmp_path / "scenario" / f"{name}.yaml").write_text("_target_: mine.Scenario\n")
    found = values("scenario=all", tmp_path)
    paper = [name for name in ("intersection", "roundabout", "highway", "merge") if name in found]
    assert found[: len(paper)] == paper
    assert found[len(paper) :] == sorted(found[len(paper) :])
    assert found[-1] == "zoo"
    assert "a_junction" in found


def test_a_users_file_called_all_is_refused(tmp_path: Path) -> None:
    (tmp_path / "scenario").mkdir()
    (tmp_path / "scenario" / "all.yaml").touch()
    assert "stands for every scenario; give it another name" in refused("scenario=all", config_dir=tmp_path)
    assert "is not a folder" in refused("scenario=all", config_dir=tmp_path / "nowhere")


@pytest.mark.parametrize("key", [*ROOT, "launcher", "experiments"])
def test_what_belongs_to_the_run_takes_one_value_and_the_message_says_why(key: str) -> None:
    token = f"{key}=1,2"
    text = refused(token)
    assert text.startswith(f"{token}: {key} takes one value, since {ONE_VALUE[key]}")
    assert ("for a text with commas" in text) == (key in ROOT and ROOT[key].kind is str)


@pytest.mark.parametrize(
    ("tokens", "start"),
    [
        (["launcher=all"], "launcher=all: launcher takes one value"),
        (["launcher.cores=1,2"], "launcher.cores=1,2: launcher.cores takes one value"),
        (["scenario=intersection,nowhere"], "unknown scenario 'nowhere'; choices: intersection"),
        (["scenario=intersection,null"], "unknown scenario 'None'"),
        (["scenario=glob(x*)"], "scenario=glob(x*) stands for no value at all"),
        (["scenario.cavs=glob(*)"], "scenario.cavs=glob(*): glob(...) chooses among the files of a group"),
        (["scenario.cavs=shuffle(4,8)"], "scenario.cavs=shuffle(4,8): a table needs values in a fixed order"),
        (["method.margin=interval(1,2)"], "method.margin=interval(1,2): a table needs values in a fixed order"),
        (["scenario.cavs=range(1,5,0)"], "cannot read 'scenario.cavs=range(1,5,0)'"),
        (["scenario.cavs=4,"], "cannot read 'scenario.cavs=4,': a value is missing beside a comma; several are "),
        (["scenario.cavs=4,8", "scenario.cavs=5"], "scenario.cavs=4,8: scenario.cavs is given again"),
        (["scenario.cavs=5", "+scenario.cavs=4,8"], "+scenario.cavs=4,8: scenario.cavs is given again"),
        ([f"scenario.cavs=range(0,{MOST + 1})"], f"scenario.cavs=range(0,{MOST + 1}) asks for more than {MOST} cells"),
        (["a.b=range(0,1000000000)"], f"a.b=range(0,1000000000) asks for more than {MOST} cells"),
        (["a.b=range(0,40)", "c.d=range(0,40)"], "a.b=range(0,40) c.d=range(0,40) asks for more than"),
    ],
)
def test_what_is_refused(tokens: list[str], start: str) -> None:
    assert refused(*tokens).startswith(start)


def test_every_point_composes_to_what_it_says() -> None:
    configs = [compose(point.overrides) for point in expand(["scenario.cavs=4,8", "scenario.hdvs=[0,0],[2,4]"])]
    found = [(config["scenario"]["cavs"], config["scenario"]["hdvs"]) for config in configs]
    assert found == [(4, [0, 0]), (4, [2, 4]), (8, [0, 0]), (8, [2, 4])]
