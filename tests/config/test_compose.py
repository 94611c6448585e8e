"""Overrides in, one resolved dict out; whatever cannot be meant is refused in one line."""

from pathlib import Path

import pytest
import yaml

from codriving.config.choices import choices, styles, taking_part
from codriving.config.compose import compose, show
from codriving.errors import ConfigError


def refused(*overrides: str, config_dir: Path | None = None) -> str:
    with pytest.raises(ConfigError) as err:
        compose(overrides, config_dir)
    assert "\n" not in str(err.value)
    return str(err.value)


def test_defaults_are_plain_and_resolved() -> None:
    resolved = compose([])
    assert resolved["episodes"] == 20
    assert resolved["scenario"]["_target_"] == "codriving.environment.scenarios.intersection.Intersection"
    assert resolved["method"]["cda"] == resolved["cda"]
    assert resolved["environment"]["scenario"] == resolved["scenario"]
    assert type(resolved["method"]["cda"]) is dict
    assert "hydra" not in resolved
    assert "experiments" not in resolved


def test_what_a_method_says_for_tables_and_figures_is_no_part_of_a_run() -> None:
    assert taking_part("single-vehicle")[-2:] == ("dilu", "codriving")
    assert styles()["dilu"] == ("#cc79a7", "P", "-.")
    assert [key for key in compose(["method=dilu"])["method"] if key.startswith("_")] == ["_target_"]
    assert "leave it out" in refused("method._style_=red")
    assert "leave it out" in refused("+method._tables_={baselines: 1}")


def test_overrides_of_groups_keys_and_lists() -> None:
    resolved = compose(["cda=prescriptive", "cda.own_order=same_rule", "episodes=3", "scenario.target_speeds=[0,2,4]"])
    assert resolved["cda"]["binding"] is True
    assert resolved["method"]["cda"]["own_order"] == "same_rule"
    assert resolved["episodes"] == 3
    assert resolved["scenario"]["target_speeds"] == [0, 2, 4]


def test_a_plus_makes_no_difference() -> None:
    assert compose(["+episodes=3"]) == compose(["++episodes=3"]) == compose(["episodes=3"])
    assert compose(["+cda=prescriptive"]) == compose(["cda=prescriptive"])


@pytest.mark.parametrize("name", ["2026_01", "7", "true", "1e3", "first"])
def test_run_names_stay_as_typed(name: str) -> None:
    assert compose([f"run={name}"])["run"] == name


def test_unknown_scenario_lists_the_choices() -> None:
    known = ", ".join(choices("scenario"))
    assert refused("scenario=intersecton") == f"unknown scenario 'intersecton'; choices: {known}"


@pytest.mark.parametrize("plus", ["", "+", "++"])
def test_unknown_key_of_the_root(plus: str) -> None:
    assert refused(f"{plus}episdes=3").startswith("unknown key episdes; did you mean episodes? keys of the config: ")


@pytest.mark.parametrize(
    ("override", "start"),
    [
        ("episodes=0", "episodes must be a whole number, 1 to 100000, got 0"),
        ("episodes=many", "episodes must be a whole number, 1 to 100000, got 'many'"),
        ("episodes=", "episodes must be a whole number, 1 to 100000, got ''"),
        ("seed=-1", "seed must be"),
        ("workers=0", "workers must be a whole number, 1 to 256 or auto, got 0"),
        ("run='a b'", "run must be a name of letters"),
        ("scenario=", "unknown scenario ''"),
        ("scenario=null", "unknown scenario 'None'"),
        ("scenario=[intersection]", "scenario takes names without brackets"),
        ("scenario=intersection,merge", "scenario=intersection,merge: scenario takes one value here"),
        ("episodes=1,2", "episodes=1,2: episodes takes one value here; for a text with commas write episodes="),
        ("episodes", "episodes stands alone; write key and value without blanks: episodes=<value>"),
        ("episodes=[1", "cannot read 'episodes=[1'"),
        ("a=b=c", "cannot read 'a=b=c'"),
        ("~episodes", "~episodes: keys cannot be removed"),
        ("hydra.verbose=true", "hydra.verbose=true: Hydra's own settings"),
        ("scenario@other=intersection", "scenario@other=intersection: Hydra's own settings"),
        ("method.cda.negotiation=false", "method.cda.negotiation is cda itself; set cda.negotiation instead"),
        (
            "environment.drivers.sight=50",
            "environment.drivers.sight has moved in release 0.2; set drivers=simulator drivers.sight instead",
        ),
        ("environment.scenario.cavs=3", "environment.scenario.cavs is scenario itself; set scenario.cavs instead"),
        ("output=${nothing}", "Interpolation key 'nothing' not found"),
        ("experiments=nothing", "unknown experiments 'nothing'; choices: "),
        ("nested/group=x", "there is no group nested/group; a key of a group is written with dots: nested.group=..."),
    ],
)
def test_what_is_refused(override: str, start: str) -> None:
    assert refused(override).startswith(start)


def test_rules_between_keys() -> None:
    assert refused("seed=2147483647", "episodes=2").startswith("seed + episodes - 1 must be at most 2147483647")
    assert refused("launcher=serial", "workers=2") == "workers must be auto or 1 with launcher=serial, got 2"
    assert compose(["launcher=serial"])["workers"] == "auto"


def test_environment_variables_stay_out_of_configs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CANARY", "sk-canary")
    for spelling in ("output=${oc.env:CANARY}", "output='${ oc.env:CANARY}'", "output=x${oc.env:NOT_SET,y}"):
        text = refused(spelling)
        assert text.startswith("output reads an environment variable")
        assert "sk-canary" not in text


@pytest.mark.parametrize(
    "token",
    [
        "llm.api_base=http://127.0.0.1/v1?api_key=hunter2-canary",
        "output=http://me:hunter2-canary@host/",
        "llm.model=sk-hunter2canary00,b",
        "llm.extra={'my_token': hunter2-canary",
    ],
)
def test_what_looks_like_a_secret_is_in_no_message(token: str) -> None:
    assert "hunter2" not in refused(token)


def test_an_experiment_is_a_delta_and_the_command_line_wins() -> None:
    assert compose(["experiments=ablation"])["experiment"] == "ablate"
    resolved = compose(["experiments=ablation", "episodes=2", "cda=status_sharing"])
    assert resolved["episodes"] == 2
    assert resolved["cda"]["intent_sharing"] is False


def test_the_working_directory_does_not_matter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    here = compose([])
    monkeypatch.chdir(tmp_path)
    assert compose([]) == here


def user_folder(root: Path, group: str, name: str, text: str) -> Path:
    (root / group).mkdir(parents=True, exist_ok=True)
    (root / group / f"{name}.yaml").write_text(text)
    return root


@pytest.mark.parametrize("name", ["mine", "with blank", "it's, {odd}=1", "ünïcode"])
def test_config_dir_adds_choices(tmp_path: Path, name: str) -> None:
    folder = user_folder(tmp_path / name, "scenario", "t_junction", "_target_: my_package.TJunction\narms: 3\n")
    resolved = compose(["scenario=t_junction", "plugins=[my_package]"], folder)
    assert resolved["scenario"] == {"_target_": "my_package.TJunction", "arms": 3}
    assert "t_junction" in refused("scenario=nothing", config_dir=folder)


def test_config_dir_may_be_relative(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    user_folder(tmp_path / "mine", "scenario", "t_junction", "_target_: my_package.TJunction\n")
    monkeypatch.chdir(tmp_path)
    assert compose(["scenario=t_junction"], Path("mine"))["scenario"] == {"_target_": "my_package.TJunction"}


def test_config_dir_mistakes(tmp_path: Path) -> None:
    assert "is not a folder" in refused(config_dir=tmp_path / "nowhere")
    folder = user_folder(tmp_path, "scenario", "intersection", "_target_: my_package.Mine\n")
    assert "has the name of a built-in scenario" in refused(config_dir=folder)
    (tmp_path / "scenario" / "intersection.yaml").unlink()
    (tmp_path / "config.yaml").write_text("episodes: 3\n")
    assert "would never be read" in refused(config_dir=tmp_path)


def test_a_broken_yaml_is_the_users_to_mend(tmp_path: Path) -> None:
    folder = user_folder(tmp_path, "scenario", "broken", "_target_: [unclosed\n")
    assert "broken.yaml" in refused("scenario=broken", config_dir=folder)
    folder = user_folder(tmp_path, "scenario", "empty", "")
    assert refused("scenario=empty", config_dir=folder).startswith("scenario")


def test_shown_config_reads_back_the_same() -> None:
    resolved = compose(["run=2026_01", "cda=prescriptive"])
    assert yaml.safe_load(show(resolved)) == resolved
