"""What the shell offers after TAB."""

from pathlib import Path

import pytest
from typer.core import TyperGroup
from typer.main import get_command

from codriving.cli.app import app
from codriving.cli.completion import (
    complete_axis,
    complete_group,
    complete_in_line,
    complete_layout,
    complete_override,
    complete_table,
)
from codriving.config.choices import choices

SCENARIOS = [*choices("scenario"), "all"]


def offered(incomplete: str) -> list[str]:
    return [word for word, _ in complete_override(incomplete)]


@pytest.fixture(autouse=True)
def no_bash(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("COMP_WORDS", raising=False)
    monkeypatch.delenv("COMP_CWORD", raising=False)


def bash(monkeypatch: pytest.MonkeyPatch, *words: str) -> list[str]:
    """Offer as in bash, which has split the words at ``=`` and puts the cursor into the last one."""
    monkeypatch.setenv("COMP_WORDS", "\n".join(["codriving", "run", *words]))
    monkeypatch.setenv("COMP_CWORD", str(len(words) + 1))
    return offered("" if words[-1] == "=" else words[-1])


def test_groups_come_with_their_choices() -> None:
    assert offered("scen") == [f"scenario={name}" for name in SCENARIOS]
    assert set(offered("cda=")) >= {"cda=full", "cda=prescriptive", "cda=status_sharing"}
    assert offered("llm=of") == ["llm=offline"]


def test_keys_come_with_their_values() -> None:
    assert offered("epi") == ["episodes=20"]
    assert offered("cda.nego") == ["cda.negotiation=true", "cda.negotiation=false"]
    assert offered("scenario.cav") == ["scenario.cavs=4", "scenario.cav_speed=[5.0,9.0]"]


def test_all_is_offered_where_several_can_be_taken() -> None:
    assert offered("cda=a") == ["cda=agreement_seeking", "cda=all"]
    assert "launcher=all" not in offered("launcher=")
    assert "experiments=all" not in offered("experiments=")
    assert offered("memory=") == ["memory=off", "memory=frozen", "memory=online"]
    assert dict(complete_override("scenario=all"))["scenario=all"].startswith("Every one of these")


def test_after_a_comma_comes_what_has_not_been_named() -> None:
    assert offered("scenario=merge,") == [f"scenario=merge,{name}" for name in SCENARIOS[:-1] if name != "merge"]
    assert offered("cda=full,status_sharing,p") == ["cda=full,status_sharing,prescriptive"]
    assert offered("cda.negotiation=true,") == ["cda.negotiation=true,false"]
    assert offered("cda.negotiation=true,false,") == []
    assert offered("launcher=serial,") == []
    assert offered("episodes=3,") == []
    assert offered("scenario.hdvs=[2,") == ["scenario.hdvs=[2,4]"]


def test_choices_are_described() -> None:
    assert dict(complete_override("cda=pres"))["cda=prescriptive"].startswith("SAE J3216 class D")


def test_nothing_fits() -> None:
    assert offered("zzz") == []
    assert offered("cda=zzz") == []
    assert offered("nonsense.key") == []


def test_bash_gets_only_what_follows_the_equals_sign(monkeypatch: pytest.MonkeyPatch) -> None:
    assert bash(monkeypatch, "scenario", "=") == SCENARIOS
    assert bash(monkeypatch, "scenario", "=", "int") == ["intersection"]
    assert bash(monkeypatch, "episodes", "=", "3", "cda", "=", "agr") == ["agreement_seeking"]
    assert bash(monkeypatch, "scenario", "=", "intersection,mer") == ["intersection,merge"]
    assert bash(monkeypatch, "scen") == [f"scenario={name}" for name in SCENARIOS]
    assert bash(monkeypatch, "scenario", "=", "intersection", "llm")[0] == "llm=offline"


def test_groups_of_list() -> None:
    assert complete_group("sce") == ["scenarios"]
    assert "experiments" in complete_group("")


def test_axes_of_stress(tmp_path: Path) -> None:
    commands = get_command(app)
    assert isinstance(commands, TyperGroup)

    def offered_axes(incomplete: str, *words: str) -> list[str]:
        line = commands.commands["stress"].make_context("stress", list(words), resilient_parsing=True)
        return [name for name, _ in complete_axis(line, incomplete)]

    assert offered_axes("") == [*choices("stress"), "all"]
    assert offered_axes("hum") == ["humans"]
    assert "cavs,humans" in offered_axes("cavs,")
    assert not {"cavs,cavs", "cavs,all"} & set(offered_axes("cavs,"))
    (tmp_path / "stress").mkdir()
    (tmp_path / "stress" / "mine.yaml").write_text("# Mine.\n")
    assert offered_axes("mi", "--config-dir", str(tmp_path)) == ["mine"]


def test_tables_of_compare() -> None:
    assert [name for name, _ in complete_table("")] == [
        "baselines",
        "single-vehicle",
        "all",
        "methods",
        "load",
        "orders",
        "filters",
        "models",
    ]
    assert [name for name, _ in complete_table("b")] == ["baselines"]


@pytest.fixture
def own(tmp_path: Path) -> Path:
    """A config folder of a user's."""
    (tmp_path / "scenario").mkdir()
    text = "# A street.\n_target_: my_roads.Street\nplugins: [my_roads]\ncurbs: 2\nwidth: 4.0\n"
    (tmp_path / "scenario" / "street.yaml").write_text(text)
    return tmp_path


def in_line(*words: str, incomplete: str) -> list[str]:
    """Offer as the shell does, after a line that has been parsed as far as it goes."""
    commands = get_command(app)
    assert isinstance(commands, TyperGroup)
    line = commands.commands["run"].make_context("run", list(words), resilient_parsing=True)
    return [word for word, _ in complete_in_line(line, incomplete)]


def test_own_scenarios_are_offered_after_their_folder(own: Path) -> None:
    assert in_line("--config-dir", str(own), incomplete="scenario=s") == ["scenario=street"]
    assert in_line("--config-dir", str(own), incomplete="scenario=merge,s") == ["scenario=merge,street"]
    assert in_line(incomplete="scenario=s") == []


@pytest.mark.parametrize("chosen", [["scenario=street"], ["scenario", "=", "street"], ["scenario=street,merge"]])
def test_keys_are_those_of_what_has_been_chosen(own: Path, chosen: list[str]) -> None:
    words = in_line("--config-dir", str(own), "episodes=3", *chosen, incomplete="scenario.")
    assert words == ["scenario.curbs=2", "scenario.width=4.0"]
    assert in_line("scenario=merge", incomplete="scenario.r") == ["scenario.ramp_hdvs=0.3"]
    assert in_line("scenario=nonsense", incomplete="scenario.") == []


def test_keys_are_those_of_the_suite(tmp_path: Path) -> None:
    (tmp_path / "suite").mkdir()
    (tmp_path / "suite" / "mine.yaml").write_text(
        "# @package _global_\n# Mine.\ndefaults:\n  - override /limits: none\n"
    )
    headway, lateral = "drivers.headway=1.5", "limits.lateral=4.0"
    assert (headway in in_line(incomplete="drivers."), lateral in in_line(incomplete="limits.")) == (False, True)
    assert headway in in_line("suite=paper", incomplete="drivers.")
    assert in_line("suite=paper", incomplete="limits.") == []
    assert in_line("--config-dir", str(tmp_path), "suite=mine", incomplete="limits.") == []
    assert lateral in in_line("suite=paper", "limits=road", incomplete="limits.")
    assert in_line(incomplete="suite=p") == ["suite=paper", "suite=poor_radio"]


def test_layouts_of_export_are_offered() -> None:
    assert complete_layout("") == ["fcd", "interhub", "csv", "sft"]
    assert complete_layout("f") == ["fcd"]
