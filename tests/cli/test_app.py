"""Help, lists, versions and exit codes of the command line, in this process."""

from pathlib import Path
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner, Result

from codriving import __version__
from codriving.cli import commands
from codriving.cli.app import app
from codriving.cli.completion import PLURALS
from codriving.config.choices import choices
from codriving.config.locate import conf_dir


def call(*args: str) -> Result:
    return CliRunner().invoke(app, list(args))


def test_version() -> None:
    result = call("--version")
    assert (result.exit_code, result.stdout) == (0, f"codriving {__version__}\n")


@pytest.mark.parametrize(
    "command",
    [
        (),
        ("run",),
        ("ablate",),
        ("compare",),
        ("learn",),
        ("check",),
        ("list",),
        ("memory", "build"),
        ("memory", "show"),
        ("memory", "search"),
        ("memory", "merge"),
    ],
)
def test_every_help_shows_an_example(command: tuple[str, ...]) -> None:
    result = call(*command, "--help")
    assert result.exit_code == 0
    assert "Example: codriving " in result.stdout


@pytest.mark.parametrize(
    ("group", "name"),
    [
        ("scenarios", "intersection"),
        ("scenario", "intersection"),
        ("methods", "codriving"),
        ("llms", "offline"),
        ("cdas", "prescriptive"),
        ("metrics", "authors"),
        ("experiments", "ablation"),
        ("executor", "layered"),
        ("launchers", "threads"),
        ("memories", "frozen"),
        ("train", "ppo_lanes"),
    ],
)
def test_list_names_and_describes_choices(group: str, name: str) -> None:
    lines = call("list", group).stdout.splitlines()
    found = next(line for line in lines if line.split()[0] == name)
    assert len(found.split()) > 3


def test_experiment_without_a_name_lists_what_can_be_driven() -> None:
    result = call("experiment")
    assert result.exit_code == 0
    lines = {line.split()[0]: line for line in result.stdout.splitlines()}
    assert set(lines) == {*choices("experiments"), "paper"}
    assert "(its Fig. 5)" in lines["ablation"]


def test_every_group_of_configs_can_be_listed() -> None:
    folders = {path.name for path in conf_dir().iterdir() if path.is_dir()}
    assert folders <= set(PLURALS.values())
    assert all(call("list", group).exit_code == 0 for group in (*PLURALS, *folders))


def test_a_list_on_a_terminal_keeps_within_its_width(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setattr(commands, "sys", SimpleNamespace(stdout=SimpleNamespace(isatty=lambda: True)))
    for group in ([], ["methods"], ["trainings"]):
        lines = call("list", *group).stdout.splitlines()
        assert max(map(len, lines)) <= 80
        assert any(line.startswith(" " * 21) for line in lines)


def test_list_names_the_word_for_every_choice_where_there_is_one() -> None:
    *names, last = (line.split() for line in call("list", "scenarios").stdout.splitlines())
    assert [words[0] for words in names] == list(choices("scenario"))
    assert last[0] == "all"
    overview = {line.split()[0]: line for line in call("list").stdout.splitlines()}
    assert overview["scenarios"].endswith("or all")
    assert not any(overview[plural].endswith("all") for plural in ("launchers", "memories", "experiments"))
    assert "all" not in call("list", "launchers").stdout.split()


def test_list_without_a_group_shows_all_groups() -> None:
    result = call("list")
    assert result.exit_code == 0
    assert [line.split()[0] for line in result.stdout.splitlines()] == [
        "scenarios",
        "methods",
        "executors",
        "orders",
        "filters",
        "cdas",
        "llms",
        "memories",
        "metrics",
        "launchers",
        "limits",
        "drivers",
        "flows",
        "channels",
        "judgements",
        "suites",
        "experiments",
        "trainings",
        "axes",
    ]


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (("list", "cars"), "unknown group 'cars'; choices: scenarios, "),
        (("compare", "baseline"), "unknown table 'baseline'; write codriving compare TABLE [KEY=VALUE]..., tables: "),
        (("compare",), "compare needs the name of a table; "),
        (
            ("stress",),
            "stress needs the name of an axis; write codriving stress AXIS [KEY=VALUE]..., axes: age, loss, range",
        ),
        (("stress", "humans,typo"), "unknown axis 'typo'; write codriving stress AXIS [KEY=VALUE]..., axes: age, "),
        (("stress", "cavs", "scenario.cavs=4"), "scenario.cavs is what the axis cavs varies; leave scenario.cavs out"),
        (("stress", "cavs", "flow=steady"), "codriving stress pairs episodes, and in flows nothing is paired; "),
        (("compare", "single"), "unknown table 'single'; write codriving compare TABLE [KEY=VALUE]..., tables: base"),
        (("compare", "single-vehicle", "method=typo"), "unknown method 'typo'; choices: fcfs, idfst, mcts, coop_game"),
        (("compare", "all", "episodes=0"), "episodes must be a whole number, 1 to 100000, got 0"),
        (("compare", "baselines", "method=typo"), "unknown method 'typo'; choices: "),
        (("compare", "load", "--cfg", "scenario=merge", "scenario.cavs=4,99"), "in the cell scenario.cavs=99 method="),
        (("compare", "baselines", "--cfg", "scenario=nowhere"), "unknown scenario 'nowhere'; choices: intersection"),
        (("run", "scenario=nowhere"), "unknown scenario 'nowhere'; choices: intersection"),
        (
            ("run", "scenario.cvas=4"),
            "unknown key scenario.cvas; did you mean scenario.cavs? keys of scenario: blind",
        ),
        (("run", "+scenario.typo=3"), "unknown key scenario.typo; "),
        (("run", "episdes=3"), "unknown key episdes; did you mean episodes?"),
        (("run", "episodes=0"), "episodes must be a whole number, 1 to 100000, got 0"),
        (("run", "episodes=two"), "episodes must be a whole number, 1 to 100000, got 'two'"),
        (("run", "scenario.cavs=99"), "scenario.cavs must be 2 to 12, got 99"),
        (("run", "scenario.cavs=four"), "scenario.cavs must be a whole number, got 'four'"),
        (("run", "scenario.hdvs=3"), "scenario.hdvs must be a list of 2 values, got 3"),
        (("run", "cda.own_order=mine"), "cda.own_order must be one of own_view, same_rule, independent, got 'mine'"),
        (("run", "scenario._target_=os.system"), "scenario._target_ may name classes of codriving"),
        (("run", "cda=prescriptive", "cda.negotiation=false"), "cda.binding=true needs cda.negotiation=true"),
        (("run", "memory.shots=3"), "memory has no _target_"),
        (("run", "--config-dir", "/nowhere"), "--config-dir /nowhere is not a folder"),
        (("run", "scenario=intersection,nowhere"), "unknown scenario 'nowhere'; choices: intersection"),
        (("run", "scenario.cavs=4,99"), "in the cell scenario.cavs=99: scenario.cavs must be 2 to 12, got 99"),
        (("run", "episodes=10,20"), "episodes=10,20: episodes takes one value, since all cells drive the same seeds"),
        (("run", "--cfg", "scenario.cavs=4,99"), "in the cell scenario.cavs=99: scenario.cavs must be"),
        (("ablate", "scenario.cavs=4,99"), "in the cell scenario.cavs=99: scenario.cavs must be"),
        (("ablate", "--cfg", "run=a,b"), "run=a,b: run takes one value, since a sweep is one run under one name"),
        (("ablate", "episodes=0"), "episodes must be"),
        (("run", "--cfg", "scenario.cavs=99"), "scenario.cavs must be 2 to 12, got 99"),
    ],
)
def test_a_users_mistake_is_one_line_and_exit_code_2(args: tuple[str, ...], said: str) -> None:
    result = call(*args)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith(f"error: {said}")
    assert result.stderr.count("\n") == 1
    assert "hunter2" not in result.stderr


def test_a_bug_is_one_line_that_names_the_file_of_its_traceback(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def broken(*_: object) -> int:
        raise RuntimeError("a bug")

    monkeypatch.setattr("codriving.commands.run_command", broken)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    result = call("run")
    assert (result.exit_code, result.stdout) == (2, "")
    (file,) = tmp_path.iterdir()
    assert f"RuntimeError: a bug); its traceback is in {file}: " in result.stderr
    assert result.stderr.count("\n") == 1
    assert "in broken" in file.read_text()


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (("run", "--episodes", "5"), "--episodes is not an option; settings are written without dashes: episodes=5; "),
        (("run", "--episodes=5"), "--episodes is not an option; settings are written without dashes: episodes=5; "),
        (("ablate", "--seed"), "--seed is not an option; settings are written without dashes: seed=<value>; "),
        (("run", "--scenario.cavs", "4"), "--scenario.cavs is not an option; settings are written without dashes: sc"),
        (("run", "-m", "seed=1"), "-m is not needed: values with commas make a sweep, for instance scenario=intersec"),
        (("run", "episodes", "5"), "episodes stands alone; write key and value without blanks: episodes=5"),
        (("run", "episodes:5"), "episodes:5 is no setting; write key and value with a sign between: episodes=5"),
        (("run", "episodes=٣"), "cannot read 'episodes=٣'; numbers are written with the digits 0 to 9: episodes=3"),
        (("run", "seed=²⁰"), "cannot read 'seed=²⁰'; numbers are written with the digits 0 to 9: seed=20"),
        (("run", "llm/foo=1"), "there is no group llm/foo; a key of a group is written with dots: llm.foo=..."),
        (("run", "+memory/embedder=x"), "there is no group memory/embedder; a key of a group is written with dots: "),
        (
            (
                "run",
                "llm=custom",
                "llm.model=openai/m",
                "llm.api_base=http://127.0.0.1:9/v1",
                "llm.extra=sk-hunter2canary00",
            ),
            "llm.extra must be a mapping, got a value that is not shown",
        ),
        (("run", "method=sk-hunter2canary00"), "unknown method"),
        (("run", "episodes=sk-hunter2canary00"), "episodes must be "),
        (("run", "episodes==5"), "cannot read 'episodes==5'; write episodes=5"),
        (("run", "episodes", "=", "5"), "episodes stands alone; write key and value without blanks: episodes=5"),
        (("compare", "baselines", "episodes=", "5"), "episodes stands alone; write key and value without blanks: epis"),
        (("memory", "build", "interactions", "5"), "interactions stands alone; write key and value without blanks: in"),
        (("train", "madqn", "seed", "5"), "seed stands alone; write key and value without blanks: seed=5"),
        (("run", "llm.api_key", "sk-1"), "llm.api_key stands alone; write key and value without blanks: llm.api_key=<"),
        (("rum",), "No such command 'rum'. Did you mean 'run'?; "),
        (("replay", "x", "--episode", "²"), "Invalid value for '--episode': "),
        (
            ("run", "output=übung"),
            """cannot read 'output=übung': a text with other characters than letters of a to z, """,
        ),
        (
            ("run", "memory.file=a#1"),
            "cannot read 'memory.file=a#1': a text with other characters than letters of a to",
        ),
        (("run", f"episodes={'9' * 5000}"), "cannot read 'episodes=9999"),
        (("run", f"episodes={'[' * 3000}"), "cannot read 'episodes=[[[["),
        (
            ("learn", "interactions=²"),
            "interactions must be whole numbers from 0 to 10000, for instance interactions=0,",
        ),
        (("memory", "build", "interactions=²"), "interactions must be a whole number, 1 to 10000, got '²'"),
        (("memory", "build", f"interactions={'1' * 5000}"), "interactions must be a whole number, 1 to 10000, got '11"),
        (
            ("run", "plugins=[nope]"),
            "plugins: there is no module nope; install it, or put it beside the folder that --config-dir ",
        ),
        (("x" * 5000,), "No such command 'xxxxxx"),
        (("run", "run=a\0b"), "'run=a\\x00b' holds bytes that are no text in "),
        (("replay", "a\udcff"), "'a\\udcff' holds bytes that are no text in "),
    ],
)
def test_what_is_written_otherwise_is_shown_as_it_is_written_here(args: tuple[str, ...], said: str) -> None:
    result = call(*args)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith(f"error: {said}")
    assert result.stderr.count("\n") == 1


def test_the_quoting_that_is_shown_works() -> None:
    assert call("run", "output=übung").stderr.endswith("""; write output='"übung"'\n""")
    assert call("run", "--cfg", 'output="übung"').stdout.count("output: übung\n") == 1


@pytest.mark.parametrize("token", ["output=~/runs", 'output="~/runs"', "++output=~/runs"])
def test_a_tilde_is_the_home_folder(token: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", "/home/me and others")
    assert "output: /home/me and others/runs\n" in call("run", "--cfg", token).stdout


def test_a_current_folder_that_is_gone_is_said(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    result = call("run", "episodes=1")
    assert (result.exit_code, result.stdout) == (2, "")
    said = "error: the current folder cannot be used (No such file or directory); change to one that exists\n"
    assert result.stderr == said


def test_an_interruption_before_the_batch_is_exit_code_130(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr("codriving.commands.run_command", interrupted)
    assert call("run").exit_code == 130


@pytest.mark.parametrize("code", [0, 1, 130])
def test_the_exit_code_is_the_experiments(monkeypatch: pytest.MonkeyPatch, code: int) -> None:
    given: list[object] = []

    def experiment(*args: object) -> int:
        given.extend(args)
        return code

    monkeypatch.setattr("codriving.commands.run_command", experiment)
    assert call("run", "episodes=3", "+seed=4").exit_code == code
    assert given[1:] == [["episodes=3", "+seed=4"], None, False]


@pytest.mark.parametrize(("command", "cells"), [("run", 2), ("ablate", 22)])
def test_cfg_of_a_sweep_is_a_document_for_each_cell(command: str, cells: int) -> None:
    import yaml

    text = call(command, "--cfg", "scenario.cavs=4,8", "episodes=3").stdout
    documents = list(yaml.safe_load_all(text))
    assert len(documents) == cells
    assert [shown["scenario"]["cavs"] for shown in documents] == [4] * (cells // 2) + [8] * (cells // 2)
    assert f"# cell {cells // 2 + 1} of {cells}: scenario.cavs=8\n" in text
    assert ("cda.safety_check=false" in text) == (command == "ablate")


def test_cfg_prints_the_config_and_runs_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    import yaml

    monkeypatch.setattr("codriving.commands.run.driving", None)
    result = call("run", "--cfg", "episodes=3", "cda=prescriptive")
    assert result.exit_code == 0
    shown = yaml.safe_load(result.stdout)
    assert shown["episodes"] == 3
    assert shown["cda"]["binding"] is True
