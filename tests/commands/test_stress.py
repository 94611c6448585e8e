"""`codriving stress`: what it drives, and a short run of it with the real simulator."""

import csv
from pathlib import Path

import pytest

from codriving.commands import run_command, stress_command
from codriving.commands.stress import stress_points
from codriving.config.compose import compose
from codriving.config.stress import stress_axis
from codriving.config.sweep import Point
from codriving.errors import ConfigError

ROWS = [
    ("codriving", "full"),
    ("codriving", "intent_sharing"),
    ("codriving", "without intents"),
    ("codriving", "status_sharing"),
    ("fcfs", ""),
    ("mcts", ""),
    ("pidm", ""),
]
CONTROLS = ["fastest", "random_action", "random_order", "idm", "oracle"]

FEW = """# Two and three CAVs.
name: CAVs
unit: ""
levels:
  - value: 2
    set: [scenario.cavs=2]
  - value: 3
    set: [scenario.cavs=3, 'scenario.hdvs=[1,1]']
"""
SIGHT = """# CAVs see less far.
name: sight
unit: m
levels:
  - value: 50
    set: [scenario.cavs=2]
  - value: 30
    set: [scenario.cavs=2, scenario.detection_range=30.0]
"""


def points(*overrides: str, axes: str = "humans") -> list[Point]:
    return stress_points([stress_axis(name) for name in axes.split(",")], overrides)


def rows_of(found: list[Point]) -> list[tuple[str, str]]:
    def cda(point: Point) -> str:
        return point.swept.get("cda", "without intents" if "cda.intent_sharing" in point.swept else "")

    return list(dict.fromkeys((point.swept["method"], cda(point)) for point in found))


def test_the_usual_rows_at_four_levels_each() -> None:
    found = points()
    assert rows_of(found) == [*ROWS, *((name, "") for name in CONTROLS)]
    assert [point.swept["stress"] for point in found] == [
        "humans 0 %",
        "humans 10 %",
        "humans 20 %",
        "humans 30 %",
    ] * 12
    assert found[1].overrides == (
        *("experiment=stress", "scenario=intersection", "episodes=60", "method=codriving", "cda=full"),
        *("drivers=attentive", "drivers.shares.attentive=0.9", "drivers.shares.nonyielding=0.1"),
    )
    assert "cda.intent_sharing=false" in found[8].overrides


@pytest.mark.parametrize(
    ("tokens", "rows"),
    [
        (["controls=false"], ROWS),
        (["controls=false", "method=codriving,idfst"], [("codriving", ""), ("idfst", "")]),
        (["controls=false", "cda=prescriptive"], [("codriving", ""), ("fcfs", ""), ("mcts", ""), ("pidm", "")]),
        (["controls=true", "method=idm"], [(name, "") for name in ("idm", *CONTROLS[:3], "oracle")]),
    ],
)
def test_rows_are_those_that_are_asked_for(tokens: list[str], rows: list[tuple[str, str]]) -> None:
    assert rows_of(points(*tokens)) == rows


def test_what_is_set_wins_over_what_is_usual() -> None:
    tokens = points("episodes=3", "scenario=merge", "experiment=mine")[0].overrides
    assert tokens[:3] == ("episodes=3", "scenario=merge", "experiment=mine")
    assert "scenario=intersection" not in points("suite=ring")[0].overrides


def test_suites_and_other_keys_with_several_values_are_settings() -> None:
    found = points("suite=standoff,crowd", "scenario.time_limit=20,30", "controls=false", "method=fcfs", axes="humans")
    settings = dict.fromkeys((p.swept["suite"], p.swept["scenario.time_limit"]) for p in found)
    assert list(settings) == [("standoff", "20"), ("standoff", "30"), ("crowd", "20"), ("crowd", "30")]
    assert len(found) == 16


def test_several_axes_come_one_after_the_other() -> None:
    found = points("controls=false", "method=fcfs", axes="humans,cavs")
    assert [point.swept["stress"] for point in found] == [
        *("humans 0 %", "humans 10 %", "humans 20 %", "humans 30 %", "cavs 2", "cavs 4", "cavs 6", "cavs 8")
    ]
    assert stress_command("all").name == "stress all"


@pytest.mark.parametrize("key", ["drivers=rough", "drivers.shares.nonyielding=0.2", "drivers.shares={attentive: 1}"])
def test_what_an_axis_varies_cannot_be_set(key: str) -> None:
    with pytest.raises(ConfigError, match=r"drivers\S* is what the axis humans varies; leave drivers\S* out, or the"):
        points(key)


def test_a_slip_is_told_without_composing_every_cell(monkeypatch: pytest.MonkeyPatch) -> None:
    composed = []

    def noted(overrides: tuple[str, ...], config_dir: Path | None) -> dict[str, object]:
        composed.append(overrides)
        return compose(overrides, config_dir)

    monkeypatch.setattr("codriving.commands.stress.compose", noted)
    for slip, said in (("scenario.cvas=4", "^unknown key scenario.cvas; did you"), ("episodes=0", "^episodes must be")):
        with pytest.raises(ConfigError, match=said):
            stress_command("humans").points([slip], None)
    assert len(composed) == 4


def test_what_an_axis_leaves_alone_can_be_set() -> None:
    assert "drivers.signals=0.5" in points("drivers.signals=0.5")[0].overrides


def run(folder: Path, *tokens: str, axes: str = "few,sight") -> Path:
    short = ("launcher=serial", "scenario.time_limit=3", "seed=10000", "controls=false", "run=x", f"output={folder}")
    own = folder / "conf"
    assert run_command(stress_command(axes, own), [*short, *tokens], own) == 0
    return folder / "stress" / "x"


def table(file: Path) -> list[dict[str, str]]:
    with file.open(newline="") as text:
        return list(csv.DictReader(text))


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two methods at the levels of two axes whose first level is the same."""
    folder = tmp_path_factory.mktemp("stress")
    (folder / "conf" / "stress").mkdir(parents=True)
    (folder / "conf" / "stress" / "few.yaml").write_text(FEW)
    (folder / "conf" / "stress" / "sight.yaml").write_text(SIGHT)
    return run(folder, "episodes=1", "method=codriving,fcfs")


def test_every_level_of_every_curve_has_a_row(driven: Path) -> None:
    rows = table(driven / "stress.csv")
    assert [(row["axis"], row["method"], row["level"], row["value"]) for row in rows] == [
        (axis, method, str(level), value)
        for axis, values in (("few", ("2", "3")), ("sight", ("50", "30")))
        for method in ("codriving", "fcfs")
        for level, value in enumerate(values)
    ]
    assert {row["episodes"] for row in rows} == {"1"}
    assert [row["success_pairs"] for row in rows] == ["", "1"] * 4
    breaking = table(driven / "breaking.csv")
    assert [(row["axis"], row["method"]) for row in breaking] == [
        (axis, method) for axis in ("few", "sight") for method in ("codriving", "fcfs")
    ]
    assert {path.name for path in (driven / "figures").iterdir()} == {
        f"stress-{axis}.{kind}" for axis in ("few", "sight") for kind in ("png", "svg")
    }


def test_levels_that_are_the_same_config_are_driven_once(driven: Path) -> None:
    """The first level of both axes is two CAVs."""
    assert len(list((driven / "episodes").iterdir())) == 6
    summary, page = (driven / "summary.md").read_text(), (driven / "stress.md").read_text()
    note = "stress=sight 50 m is the same configuration as stress=few 2 and has no row of its own."
    assert summary.count(note) == 1
    assert note not in page


def test_the_page_has_tables_and_notes_of_each_axis(driven: Path) -> None:
    page = (driven / "stress.md").read_text()
    assert page.count("# stress: ") == 2
    assert page.count("Two and three CAVs.") == page.count("CAVs see less far.") == 1
    assert page.count("Breaks at: the first level at which success is 5 points") == 1


def test_a_run_is_resumed_and_repeats_to_the_byte(driven: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = {path: path.read_bytes() for path in driven.rglob("stress*") if path.is_file()}
    run(driven.parents[1], "episodes=1", "method=codriving,fcfs")
    out = capsys.readouterr().out
    assert out.startswith("Nothing to do: all 6 episodes")
    assert "stress: CAVs - intersection - reasoner: rules (llm=offline), none - success (95 %)" in out
    assert {path: path.read_bytes() for path in files} == files
    # In another order the shared level is called after the other axis.
    run(driven.parents[1], "episodes=1", "method=codriving,fcfs", axes="sight,few")
    assert capsys.readouterr().out.startswith("Nothing to do: all 6 episodes")
    assert [row["axis"] for row in table(driven / "breaking.csv")] == ["sight", "sight", "few", "few"]
    assert len(list((driven / "episodes").iterdir())) == 6
