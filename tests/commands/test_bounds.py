"""``codriving bound``: what it prints, keeps and refuses."""

from pathlib import Path

import pytest

from codriving.commands.bounds import BoundOptions, run_bound
from codriving.errors import ConfigError

FEW = ["scenario=intersection", "episodes=2", "seed=24000", "run=few"]


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_bounds_are_printed_kept_and_not_solved_again(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_bound(FEW, BoundOptions()) == 0
    shown = capsys.readouterr().out
    assert "intersection     4      2" in shown
    assert "human drivers are left out" in shown
    file = Path("outputs/bound/few/bound.csv")
    lines = file.read_text().splitlines()
    assert lines[0] == "world,scenario,seed,cavs,bound,driven,alone,binaries,optimal"
    rows = [line.split(",") for line in lines[1:]]
    assert [row[1:4] for row in rows] == [["intersection", "24000", "4"], ["intersection", "24001", "4"]]
    assert all(float(row[4]) >= float(row[6]) > 30 for row in rows)
    # A number that is there is taken as it is.
    file.write_text("\n".join([lines[0], lines[1].replace(rows[0][4], "77.7"), ""]))
    assert run_bound(FEW, BoundOptions()) == 0
    assert "77.7" in file.read_text()
    assert file.read_text().splitlines()[2] == lines[2]


@pytest.mark.parametrize("spoilt", ["nan", "", "-3.0", "x"])
def test_a_number_that_cannot_be_one_is_solved_anew(spoilt: str) -> None:
    run_bound([*FEW, "episodes=1"], BoundOptions())
    file = Path("outputs/bound/few/bound.csv")
    whole = file.read_text()
    bound = whole.splitlines()[1].split(",")[4]
    file.write_text(whole.replace(f",{bound},", f",{spoilt},", 1))
    run_bound([*FEW, "episodes=1"], BoundOptions())
    assert file.read_text() == whole


def test_bounds_of_another_behaviour_are_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    run_bound([*FEW, "episodes=1"], BoundOptions())
    monkeypatch.setattr("codriving.commands.bounds.BEHAVIOUR", 1)
    run_bound([*FEW, "episodes=1"], BoundOptions())
    assert len(Path("outputs/bound/few/bound.csv").read_text().splitlines()) == 3


def test_rows_of_other_settings_stay_beside(capsys: pytest.CaptureFixture[str]) -> None:
    run_bound([*FEW, "episodes=1"], BoundOptions())
    run_bound(["scenario=merge", "seed=24000", "episodes=1", "run=few"], BoundOptions())
    assert "Where CAVs choose their lanes (merge) no more is proven" in capsys.readouterr().out
    run_bound([*FEW, "episodes=1"], BoundOptions(margin=0.6))
    assert "keeps 0.6 s at zones" in capsys.readouterr().out
    rows = [line.split(",") for line in Path("outputs/bound/few/bound.csv").read_text().splitlines()[1:]]
    assert sorted(row[1] for row in rows) == ["intersection", "intersection", "merge"]
    assert len({row[0] for row in rows}) == 3


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (BoundOptions(margin=5.1), r"--margin must be 0 to 5 s, got 5\.1"),
        (BoundOptions(margin=-1), "--margin must be 0 to 5 s, got -1"),
        (BoundOptions(margin=1, driven=True), "--driven keeps no margins"),
        (BoundOptions(one_order=True), "--one-order needs --margin"),
    ],
)
def test_options_out_of_range_are_refused(options: BoundOptions, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        run_bound(FEW, options)


def test_drive_is_looked_for_where_it_was_not(capsys: pytest.CaptureFixture[str]) -> None:
    one = [*FEW, "episodes=1"]
    run_bound(one, BoundOptions())
    assert "driven" not in capsys.readouterr().out
    run_bound(one, BoundOptions(driven=True))
    assert "driven [s]  gap [s]" in capsys.readouterr().out
    row = Path("outputs/bound/few/bound.csv").read_text().splitlines()[1].split(",")
    assert float(row[5]) >= float(row[4])
    with pytest.raises(ConfigError, match="choose their lanes at merge; leave it out there"):
        run_bound(["scenario=merge", "episodes=1"], BoundOptions(driven=True))


def test_margin_bound_of_free_lanes_is_refused() -> None:
    with pytest.raises(ConfigError, match="merge has no margin bound"):
        run_bound(["scenario=merge", "episodes=1"], BoundOptions(margin=0.6))


def test_what_has_no_bound_is_left_out_of_several_with_a_line(capsys: pytest.CaptureFixture[str]) -> None:
    few = ["scenario.cavs=2", "episodes=1", "seed=24000"]
    assert run_bound(["scenario.blocked_exit=0,5", "scenario.time_limit=4,60", *few], BoundOptions()) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "intersection 0 60" in shown
    assert "scenario.blocked_exit=0 scenario.time_limit=4 is left out: CAV1 does not arrive within the" in shown
    for limit in (4, 60):
        assert f"scenario.blocked_exit=5 scenario.time_limit={limit} is left out: no bound is defined at a" in shown
    for alone, said in (("blocked_exit=5", "no bound is defined"), ("time_limit=4", "CAV1 does not arrive")):
        with pytest.raises(ConfigError, match=said):
            run_bound([f"scenario.{alone}", *few], BoundOptions())


def test_a_changed_suite_is_said_to_be_another_world(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_bound(["suite=standoff", "scenario.cavs=2", "episodes=1", "seed=24000"], BoundOptions()) == 0
    assert "suite=standoff is not the world that was fixed for suite=hard" in capsys.readouterr().out
