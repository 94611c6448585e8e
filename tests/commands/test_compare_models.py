"""``codriving compare models``: which cells, what is refused in one line, and what its table says."""

import csv
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from codriving.cli.app import app
from codriving.commands.compare import comparison
from codriving.commands.compare_models import chosen
from codriving.errors import ConfigError

SHORT = ("seed=10000", "scenario.time_limit=3", "suite=standoff")


def llms(*overrides: str) -> list[list[str]]:
    """What of each cell is about its model."""
    found = []
    for point in comparison("models", overrides):
        assert point.overrides[0] == "experiment=compare-models"
        found.append([token for token in point.overrides if token.startswith("llm")])
    return found


def test_each_model_is_a_cell() -> None:
    assert llms("llm=first,random,offline", "episodes=3") == [["llm=first"], ["llm=random"], ["llm=offline"]]
    assert llms("llm=first", "llm=offline,first") == [["llm=first"], ["llm=offline"]]


def test_epochs_drive_each_seed_again_but_for_the_rules() -> None:
    assert llms("llm=offline,random", "epochs=3") == [
        ["llm=offline"],
        ["llm=random"],
        ["llm=random", "llm.epoch=2"],
        ["llm=random", "llm.epoch=3"],
    ]
    swept = [dict(point.swept) for point in comparison("models", ["llm=offline,first", "epochs=2"])]
    assert swept == [{"llm": "offline"}, {"llm": "first", "llm.epoch": "1"}, {"llm": "first", "llm.epoch": "2"}]


def test_settings_hold_for_the_models_that_have_them() -> None:
    given = ("llm.api_base=http://127.0.0.1:9/v1", "llm.label=ours", "llm.seed=4", "llm.ask_plain=true")
    assert llms("llm=first,random,offline,custom", *given) == [
        ["llm.ask_plain=true", "llm=first"],
        ["llm.seed=4", "llm.ask_plain=true", "llm=random"],
        ["llm=offline"],
        ["llm.api_base=http://127.0.0.1:9/v1", "llm.label=ours", "llm.ask_plain=true", "llm=custom"],
    ]


def test_one_epoch_alone_may_be_named() -> None:
    assert llms("llm=first", "llm.epoch=4", "epochs=1") == [["llm.epoch=4", "llm=first"]]


def test_several_values_of_other_keys_are_settings() -> None:
    assert len(llms("llm=first,offline", "suite=standoff,blind")) == 4


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        ([], "compare models needs the models to compare; write for instance codriving compare models llm=first,"),
        (["llm=nothing"], "unknown llm 'nothing'"),
        (["llm=first,nothing"], "unknown llm 'nothing'"),
        (["llm=first", "epochs=0"], "epochs must be a whole number of 1 to 100, got '0'"),
        (["llm=first", "epochs=1,2"], "epochs must be a whole number of 1 to 100, got '1,2'"),
        (["llm=first", "epochs=101"], "epochs must be a whole number of 1 to 100, got '101'"),
        (["llm=first", "llm.epoch=2", "epochs=3"], "llm.epoch is what epochs=3 varies; leave one of them out"),
        (["llm=first", "+llm.epoch=2", "epochs=3"], "llm.epoch is what epochs=3 varies; leave one of them out"),
        (["llm=first", "epochs="], "epochs must be a whole number of 1 to 100, got ''"),
    ],
)
def test_bad_input_gives_one_line(overrides: list[str], said: str) -> None:
    with pytest.raises(ConfigError) as caught:
        comparison("models", overrides)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def compared(output: Path, *more: str) -> Result:
    return CliRunner().invoke(app, ["compare", "models", *SHORT, f"output={output}", "run=mine", *more])


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["llm=first", "method=fcfs"], "method=fcfs asks no language model; choose method=codriving or method=dilu"),
        (
            ["llm=first", "flow=steady", "suite=default"],
            "codriving compare models pairs episodes, and in flows nothing",
        ),
        (["llm=first,offline", "llm.temprature=1"], "temprature"),
    ],
)
def test_what_has_no_place_for_a_model_is_refused(tmp_path: Path, more: list[str], said: str) -> None:
    result = compared(tmp_path, *more)
    assert result.exit_code == 2
    assert said in result.stderr
    assert not (tmp_path / "compare-models").exists()


def left(folder: Path) -> list[tuple[str, bytes]]:
    """What the episodes of the random control left that depends on config and seeds alone."""
    found = []
    for record in folder.glob("episodes/*/*/record.json"):
        if b"control random" in record.read_bytes():
            kept = ("record.json", "trajectory.csv", "decisions.jsonl", "transcript.jsonl")
            found += [(name, record.with_name(name).read_bytes()) for name in kept]
    return sorted(found)


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    output = tmp_path_factory.mktemp("models")
    result = compared(output, "llm=first,random,offline", "epochs=2", "episodes=1", "workers=2")
    return output / "compare-models" / "mine", result


def test_one_table_of_models_controls_and_rules(driven: tuple[Path, Result]) -> None:
    folder, result = driven
    assert result.exit_code == 0, result.output
    rows = {row["reasoner"]: row for row in csv.DictReader((folder / "models.csv").read_text().splitlines())}
    assert set(rows) == {"rules", "control first (informed)", "control random (informed)"}
    assert next(iter(rows)) == "rules"
    first, drawn, rules = rows["control first (informed)"], rows["control random (informed)"], rows["rules"]
    assert float(first["same_decisions"]) == 1
    assert float(drawn["same_decisions"]) < 1
    assert rules["same_decisions"] == rules["decisions_by_model"] == rules["model_calls"] == ""
    assert 0 < float(first["decisions_by_model"]) <= 1
    assert float(first["pairs_by_model"]) == 1
    assert 0 < float(drawn["decisions_like_rules"]) < 1
    assert float(first["cost_usd"]) == float(first["step_seconds"]) == 0
    assert int(first["prompt_tokens"]) > 1000
    assert (rules["pairs"], first["pairs"]) == ("", "1")
    page = (folder / "models.md").read_text()
    assert "Differences are each row minus rules (llm=offline)" in page
    assert "Control: no language model" in page
    assert "rules (llm=offline): the built-in rules and no language model" in page


def test_one_worker_leaves_the_same_bytes_as_two(driven: tuple[Path, Result], tmp_path: Path) -> None:
    result = compared(tmp_path, "llm=random", "epochs=2", "episodes=1", "workers=1")
    assert result.exit_code == 0, result.output
    one, two = left(tmp_path / "compare-models" / "mine"), left(driven[0])
    assert len(one) == 8
    assert one == two
    # Each epoch draws anew.
    assert len(set(one)) == 8


def test_what_an_answer_decides() -> None:
    assert chosen({"reason": "so", "action": "IDLE"}) == {"action": "IDLE"}
    pairs = {"reason": "", "p1": {"first": "CAV1", "reason": "early"}, "p2": None}
    assert chosen(pairs) == {"p1": "CAV1"}
    assert chosen({"reason": "it brakes", "p1": 0.9, "p2": 0.25}) == {"p1": 0.9, "p2": 0.25}
    assert not chosen({"lesson": "wait"})
