"""codriving learn: what is built and tested, and the table and figure that come of it."""

import csv
from pathlib import Path

import pytest

from codriving.commands.learn import build_points, frozen_points, run_learn, settings_of
from codriving.config.compose import compose
from codriving.errors import ConfigError

SHORT = ["scenario=intersection", "cda=full", "scenario.time_limit=5", "scenario.cavs=2"]


def test_all_scenarios_and_three_levels_unless_some_are_named() -> None:
    points = settings_of([], None)
    assert {(p.swept["scenario"], p.swept["cda"]) for p in points} == {
        (s, c)
        for s in ("intersection", "roundabout", "highway", "merge")
        for c in ("full", "intent_sharing", "status_sharing")
    }
    assert len(settings_of(["scenario=merge", "cda.safety_check=false"], None)) == 1


def test_what_is_learnt_on_is_never_what_is_tested_on() -> None:
    (point,) = settings_of(["scenario=merge", "cda=full", "episodes=30", "memory.shots=3"], None)
    built = compose(build_points([point], 20, "r")[0].overrides)
    tested, *controls = frozen_points([point], [Path("m.sqlite")], [2, 5], "r", ("verdicts", "rule"))[1:]
    assert [compose(p.overrides)["memory"]["control"] for p in controls] == ["verdicts", "rule"]
    assert {compose(p.overrides)["memory"]["interactions"] for p in controls} == {5}
    test = compose(tested.overrides)
    assert (built["seed"], built["episodes"], built["experiment"]) == (20_000, 20, "learn-memory")
    assert (test["seed"], test["episodes"], test["experiment"]) == (0, 30, "learn")
    assert test["memory"]["interactions"] == 5
    assert built["memory"]["shots"] == test["memory"]["shots"] == 3


def test_of_several_sites_the_memory_of_the_next_one_is_a_control() -> None:
    files = [Path(f"{name}.sqlite") for name in "abcd"]
    named = ["scenario=intersection", "cda=full,status_sharing", "drivers=site", "drivers.site=3,6"]
    points = settings_of(named, None)
    cells = frozen_points(points, files, [0, 2], "r", ("verdicts",))
    assert [p.swept["memory.control"] for p in cells[:4]] == ["none", "none", "verdicts", "elsewhere"]
    used = [t for p in cells[3::4] for t in p.overrides if t.startswith("memory.file=")]
    own = [t for p in cells[1::4] for t in p.overrides if t.startswith("memory.file=")]
    levels = [(p.swept["cda"], p.swept["drivers.site"]) for p in points]
    partner = [levels.index((cda, "6" if site == "3" else "3")) for cda, site in levels]
    assert used == [own[k] for k in partner]
    assert {compose(p.overrides)["memory"]["interactions"] for p in cells[3::4]} == {2}
    alone = frozen_points(settings_of([named[0], "cda=full"], None), files[:1], [2], "r", ("verdicts",))
    assert [p.swept["memory.control"] for p in alone] == ["none", "verdicts"]
    assert all(p.swept["memory.control"] == "none" for p in frozen_points(points, files, [0, 2], "r"))


@pytest.mark.parametrize("text", ["many", "-1", "5,x", ""])
def test_numbers_of_interactions_that_are_none_are_refused(text: str) -> None:
    with pytest.raises(ConfigError, match="interactions must be whole numbers from 0"):
        run_learn([f"interactions={text}"])


def test_the_memory_is_not_the_users_to_choose() -> None:
    with pytest.raises(ConfigError, match="codriving learn sets memory itself"):
        run_learn(["memory=off"])


def test_the_table_the_figure_and_a_second_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    command = [*SHORT, "interactions=0,2", "episodes=1", "run=x", "launcher=serial"]
    assert run_learn(command) == 0
    printed = capsys.readouterr().out
    assert "learning - intersection - reasoner: rules (llm=offline)" in printed
    run = Path("outputs/learn/x")
    with (run / "learn.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["interactions"] for row in rows] == ["0", "2", "2", "2", "2"]
    assert [row["control"] for row in rows] == ["", "", "shuffled verdicts", "shuffled situations", "one rule"]
    assert rows[2]["memory"].endswith(", 2 interactions, shuffled verdicts")
    assert "Controls are of the same memory." in printed
    assert rows[0]["mcnemar_p"] == ""
    assert float(rows[1]["mcnemar_p"]) == 1.0
    assert rows[0]["memory"].endswith(", 0 interactions")
    assert rows[0]["recalled"] == "0"
    assert (run / "figures/learn.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert (run / "learn.md").read_text().startswith("# learning")
    before = {p: p.read_bytes() for p in run.rglob("*") if p.suffix in (".csv", ".md", ".png", ".svg")}
    assert run_learn(command) == 0
    assert "Nothing to do" in capsys.readouterr().out
    assert {p: p.read_bytes() for p in before} == before


def test_without_interactions_or_if_they_are_left_out_there_are_no_controls(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for run, more in (("x", ["interactions=1", "controls=false"]), ("y", ["interactions=0"])):
        assert run_learn([*SHORT, "episodes=1", f"run={run}", "launcher=serial", *more]) == 0
        said = capsys.readouterr()
        assert "Testing: 1 episodes in each of 1 cells." in said.err
        assert "ontrol" not in said.out
