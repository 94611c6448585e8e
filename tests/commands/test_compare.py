"""What a comparison consists of: every method that there is, on the same seeds."""

import csv
from importlib import import_module
from pathlib import Path

import pytest

from codriving.commands.compare import EXPERIMENT, comparison, comparison_command, setting
from codriving.commands.run import resume_command, run_command
from codriving.config.build import build
from codriving.config.choices import TABLES, choices, taking_part
from codriving.config.compose import compose
from codriving.config.experiments import experiment_file
from codriving.config.locate import conf_dir, experiments_dir
from codriving.datatypes.world import Kind
from codriving.environment.scenarios.intersection import Intersection
from codriving.environment.scenarios.roundabout import Roundabout
from codriving.errors import ConfigError
from codriving.experiment.plan import make_plan
from codriving.reports.paper import read_paper

YAML = "# Mine.\n_target_: my_methods.Mine\nplugins: [my_methods]\n"


@pytest.fixture
def own(tmp_path: Path) -> Path:
    (tmp_path / "method").mkdir()
    for name in ("mine", "other"):
        (tmp_path / "method" / f"{name}.yaml").write_text(YAML)
    return tmp_path


def methods(table: str, *tokens: str, config_dir: Path | None = None) -> list[str]:
    """The methods of a comparison, without controls."""
    return [point.overrides[-1] for point in comparison(table, ["controls=false", *tokens], config_dir)]


def there(names: tuple[str, ...]) -> list[str]:
    return [f"method={name}" for name in names if name in choices("method")]


COMPARED = ("fcfs", "idfst", "mcts", "coop_game", "madqn", "dilu", "codriving")
SINGLE_VEHICLE = ("pidm", "noncoop_game", "ppo", "tell", "dilu", "codriving")
THERE = there(COMPARED)


def test_the_order_is_that_of_the_papers_tables() -> None:
    paper = read_paper(experiments_dir())
    assert tuple(row.method for row in paper.comparison) == taking_part("baselines") == taking_part("load") == COMPARED
    single = tuple(row.method for row in paper.single_vehicle)
    assert (*single, "dilu", "codriving") == taking_part("single-vehicle") == SINGLE_VEHICLE


def test_every_table_can_be_made_and_has_a_folder_of_its_own() -> None:
    assert set(TABLES) == set(EXPERIMENT)
    assert len(set(EXPERIMENT.values())) == len(EXPERIMENT)


def test_all_are_the_methods_of_the_paper_then_those_for_a_single_vehicle_then_codriving() -> None:
    named = taking_part("all")
    assert named[:6] == COMPARED[:-1]
    assert named[6:] == ("pidm", "noncoop_game", "ppo", "tell", "codriving")
    assert methods("all") == there(named)


def test_single_vehicle_methods_are_those_that_exist() -> None:
    assert methods("single-vehicle") == there(SINGLE_VEHICLE)
    assert methods("single-vehicle")[:2] == ["method=pidm", "method=noncoop_game"]
    assert methods("single-vehicle")[-1] == "method=codriving"


def test_the_methods_are_those_that_exist() -> None:
    assert methods("baselines") == THERE
    assert "method=codriving" in THERE


def test_a_method_of_ones_own_is_added_once_and_takes_no_place(own: Path) -> None:
    assert methods("baselines", "method=mine", config_dir=own) == [*THERE, "method=mine"]
    assert methods("load", "method=mine,codriving,other", "scenario.cavs=4", "scenario=merge", config_dir=own) == [
        *THERE,
        "method=mine",
        "method=other",
    ]


def test_a_papers_method_of_ones_own_takes_part_without_being_asked(own: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(import_module("codriving.commands.compare"), "taking_part", lambda _: ("other", "codriving"))
    assert methods("baselines", config_dir=own) == ["method=other", "method=codriving"]


def test_a_file_names_the_rows_of_a_table(own: Path) -> None:
    (own / "experiments").mkdir()
    rows = "  Theirs: [method=other]\n  Ours: [method=codriving]\n"
    (own / "experiments" / "two.yaml").write_text(f"# Mine.\ntable: baselines\nrows:\n{rows}")
    points = comparison("baselines", ["controls=false"], own, experiment_file("two", own))
    assert [point.overrides for point in points] == [
        ("experiment=two", "method=other"),
        ("experiment=two", "method=codriving"),
    ]
    for name, table in (("comparison", "baselines"), ("single_vehicle", "single-vehicle")):
        tokens = experiment_file(name).rows.values()
        assert list(tokens) == [(f"method={method}",) for method in taking_part(table)]


def test_each_scenario_and_setting_is_a_block_of_all_methods() -> None:
    points = comparison("baselines", ["scenario=merge,highway", "controls=false", "episodes=3"])
    assert [point.swept["scenario"] for point in points] == ["merge"] * len(THERE) + ["highway"] * len(THERE)
    assert points[0].overrides[:3] == ("experiment=compare", "scenario=merge", "episodes=3")
    assert points[0].swept["method"] == THERE[0].partition("=")[2]


CONTROLS = ["fastest", "random_action", "random_order", "idm", "oracle"]


@pytest.mark.parametrize("table", ["baselines", "single-vehicle", "all"])
def test_controls_are_the_last_rows_unless_they_are_left_out(table: str, own: Path) -> None:
    points = comparison(table, ["method=mine", "scenario=merge,highway"], own)
    named = [point.swept["method"] for point in points if point.swept["scenario"] == "merge"]
    assert named == [*(m.partition("=")[2] for m in methods(table)), "mine", *CONTROLS]
    assert methods(table) + [f"method={name}" for name in CONTROLS] == [p.overrides[-1] for p in comparison(table, [])]
    assert methods(table, "method=idm")[-1] == "method=idm", "one that is asked for takes part all the same"
    twice = comparison(table, ["controls=false", "controls=true"])
    assert twice[-1].swept["method"] == CONTROLS[-1], "the last word counts"
    with pytest.raises(ConfigError, match="controls must be true or false, got 'no'"):
        comparison(table, ["controls=no"])


def test_methods_are_those_that_are_named_and_the_reference(own: Path) -> None:
    for named in ("fcfs,mine", "fcfs,mine,codriving", "codriving,fcfs,mine"):
        points = comparison("methods", [f"method={named}", "scenario=merge"], own)
        assert [point.swept["method"] for point in points] == ["fcfs", "mine", "codriving"]
        assert points[0].overrides[:2] == ("experiment=compare-methods", "scenario=merge")
    with_controls = comparison("methods", ["method=fcfs", "controls=true"])
    assert [point.swept["method"] for point in with_controls] == ["fcfs", "codriving", *CONTROLS]


def test_loads_have_controls_only_if_they_are_asked_for() -> None:
    assert "method=idm" not in {point.overrides[-1] for point in comparison("load", [])}
    asked = comparison("load", ["controls=true", "scenario=merge", "scenario.cavs=4"])
    assert [point.swept["method"] for point in asked] == [*COMPARED, *CONTROLS]


def test_filters_are_each_method_without_and_with_and_the_reference_once(own: Path) -> None:
    found = [(p.swept["method"], p.overrides[-2]) for p in comparison("filters", ["method=mine", "episodes=2"], own)]
    names = [name.partition("=")[2] for name in [*methods("all")[:-1], "method=codriving", "method=mine"]]
    pairs = [(name, f"filter={value}") for name in names for value in ("false", "true")]
    assert found == [pair for pair in pairs if pair != ("codriving", "filter=true")]
    without = comparison("filters", ["cda.safety_check=false", "scenario=merge"])
    assert without[-1].overrides[-2:] == ("filter=true", "method=codriving")
    (own / "cda").mkdir()
    level = (conf_dir() / "cda" / "full.yaml").read_text()
    (own / "cda" / "bold.yaml").write_text(level.replace("safety_check: true", "safety_check: false"))
    assert comparison("filters", ["cda=bold"], own)[-1].overrides[-2:] == ("filter=true", "method=codriving")
    assert {point.overrides[0] for point in without} == {"experiment=compare-filters"}
    with pytest.raises(ConfigError, match="codriving compare filters sets filter itself"):
        comparison("filters", ["filter=true"])
    plan = make_plan(comparison("filters", ["flow=steady", "controls=false"])[:2])
    with pytest.raises(ConfigError, match="compare filters pairs episodes, and in flows nothing is paired"):
        comparison_command("filters").check(plan)


def test_controls_stand_last_in_lists() -> None:
    assert list(choices("method"))[-5:] == CONTROLS


def test_load_is_four_numbers_of_cavs_at_two_scenarios_unless_the_user_says_otherwise() -> None:
    asked = {(point.swept["scenario"], point.swept["scenario.cavs"]) for point in comparison("load", [])}
    assert asked == {(s, n) for s in ("intersection", "roundabout") for n in ("4", "6", "8", "12")}
    (merge,) = {point.overrides[:-1] for point in comparison("load", ["scenario=merge", "+scenario.cavs=4"])}
    assert merge == ("experiment=load", "scenario=merge", "+scenario.cavs=4")


def test_the_experiment_is_the_users_if_named() -> None:
    assert comparison("baselines", ["experiment=mine"])[0].overrides[0] == "experiment=mine"


@pytest.mark.parametrize(
    ("table", "tokens", "said"),
    [
        ("baseline", [], "unknown table 'baseline'; .* tables: baselines, single-vehicle, all, methods, load, orders"),
        ("scenario=merge", [], "unknown table 'scenario=merge'; write codriving compare TABLE"),
        (
            None,
            [],
            "compare needs the name of a table; .* tables: baselines, single-vehicle, all, methods, load, orders",
        ),
        ("single", [], "unknown table 'single'"),
        ("single-vehicle", ["method=typo"], "unknown method 'typo'; choices: "),
        ("methods", [], "compare methods needs the methods that are set against codriving; write for instance"),
        ("methods", ["method=codriving"], "compare methods needs the methods that are set against codriving"),
        ("methods", ["method=typo"], "unknown method 'typo'; choices: "),
        ("all", ["episodes=3,4"], "episodes takes one value"),
        ("baselines", ["method=typo"], "unknown method 'typo'; choices: "),
        ("baselines", ["method=codriving,typo"], "unknown method 'typo'; choices: "),
        ("baselines", ["episodes=3,4"], "episodes takes one value"),
        ("baselines", ["merge"], "merge stands alone; write key and value without blanks: merge=<value>"),
    ],
)
def test_what_cannot_be_compared_is_refused(table: str | None, tokens: list[str], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        comparison_command(table).points(tokens, None)


def test_cells_that_differ_in_the_method_alone_have_one_setting() -> None:
    cell = {"scenario": {"cavs": 4}, "plugins": [], "episodes": 3, "seed": 0}
    assert setting({**cell, "method": {"a": 1}}) == setting({**cell, "method": {"b": 2}, "plugins": ["mine"]})
    assert setting({**cell, "scenario": {"cavs": 8}}) != setting(cell)
    assert setting({**cell, "seed": 1}) != setting(cell)


def test_the_command_to_go_on_has_the_table_as_a_word_of_its_own() -> None:
    assert resume_command("compare load", ["episodes=3"], None, "x") == "codriving compare load episodes=3 run=x"


@pytest.mark.parametrize("scenario", ["intersection", "roundabout"])
def test_as_many_cavs_as_load_asks_for_can_start(scenario: str) -> None:
    made = build(compose([f"scenario={scenario}", "scenario.cavs=12"])["scenario"], object)
    assert isinstance(made, Intersection | Roundabout)
    assert all(sum(start.kind is Kind.CAV for start in made.scene(seed).starts) == 12 for seed in range(10000, 10010))


def test_several_suites_are_a_table_each_and_a_figure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(import_module("codriving.commands.compare"), "taking_part", lambda _: ("fcfs", "codriving"))
    own = tmp_path / "conf" / "suite"
    own.mkdir(parents=True)
    (own / "calm.yaml").write_text("# @package _global_\n# Calm: a world of mine.\nscenario:\n  cavs: 2\n")
    (own / "own.csv").write_text("suite,fixed,sha256\ncalm,2026-11-30,0\nstandoff,2026-11-30,0\n")
    tokens = ["suite=own", "episodes=1", "seed=12000", "controls=false", "launcher=serial", "run=x"]
    assert run_command(comparison_command("baselines"), [*tokens, f"output={tmp_path}"], tmp_path / "conf") == 0
    printed = capsys.readouterr().out
    titles = ["calm: comparison of methods", "calm: against codriving", "standoff: comparison", "standoff: against"]
    places = [printed.index(title) for title in titles]
    assert places == sorted(places)
    assert printed.count("Each difference is the method minus codriving") == 1
    assert "\nCalm: a world of mine.\n" in printed
    folder = tmp_path / "compare" / "x"
    page = (folder / "comparison.md").read_text()
    assert page.count("against codriving on the same seeds") == 2
    changed = "suite=calm is not the world that was fixed for suite=own on 2026-11-30"
    assert (printed.count(changed), page.count(changed)) == (1, 1), "what was not fixed is said"
    assert (folder / "figures" / "profile.png").stat().st_size > 10_000
    rows = list(csv.DictReader((folder / "comparison.csv").read_text().splitlines()))
    assert [(row["suite"], row["method"]) for row in rows if row["pairs"]] == [("calm", "fcfs"), ("standoff", "fcfs")]
    assert all(row["mcnemar_p_holm"] for row in rows if row["pairs"])
