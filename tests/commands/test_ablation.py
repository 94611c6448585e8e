"""``codriving ablate``: which cells there are, and what each is set against."""

import csv
from pathlib import Path

import pytest
from toy_plan import toy_cell, toy_plan

from codriving.commands import ablation, run
from codriving.errors import ConfigError


def test_the_ablation_removes_one_thing_at_a_time_under_three_readings() -> None:
    variations = [point.overrides for point in ablation.ablation_points(["episodes=5", "controls=false"])]
    assert variations[0] == ("experiment=ablate", "episodes=5")
    assert [v[2] for v in variations[1:]] == [
        "cda.state_sharing=false",
        "cda.intent_sharing=false",
        *["cda.negotiation=false"] * 3,
        "cda.safety_check=false",
    ]
    assert [v[-1] for v in variations[3:6]] == [f"cda.own_order={o}" for o in ("own_view", "same_rule", "independent")]
    assert ablation.ablation_points(["experiment=mine"])[0].overrides == ("experiment=mine",)


def test_an_ablation_of_several_keeps_the_rows_of_each_together() -> None:
    points = ablation.ablation_points(["scenario=intersection,merge"])
    assert [point.swept["scenario"] for point in points] == ["intersection"] * 11 + ["merge"] * 11
    assert points[11].removed == ()
    assert points[12].removed == ("cda.state_sharing=false",)


def test_an_ablation_ends_with_the_controls_of_codriving_in_its_settings() -> None:
    given = ["method=codriving", "method.margin=1.2", "cda=agreement_seeking", "episodes=5"]
    found = [point.overrides for point in ablation.ablation_points(given)][7:]
    margin = ("method.margin=1.2",)
    assert found == [
        ("experiment=ablate", *kept, "cda=agreement_seeking", "episodes=5", f"method={name}")
        for name, kept in (("fastest", margin), ("random_action", margin), ("random_order", margin), ("idm", ()))
    ]
    assert len(ablation.ablation_points(["method=fcfs"])) == 7, "they are controls of no other method"
    assert len(ablation.ablation_points(["controls=false"])) == 7


def test_a_method_without_sub_modules_cannot_be_ablated(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    plan = toy_plan(tmp_path, cells=(toy_cell(a=1), toy_cell(a=2)))
    monkeypatch.setattr(run, "make_plan", lambda points, config_dir: plan)
    with pytest.raises(ConfigError, match="method 'steady' has no reasoning sub-modules"):
        run.run_command(ablation.ABLATE, [])


def test_each_row_is_set_against_the_full_method_of_its_suite(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    removals = ((), ("cda.safety_check=false",))
    monkeypatch.setattr(ablation, "REMOVALS", removals)
    tokens = ["suite=honest,standoff", "episodes=1", "seed=12000", "controls=false", "launcher=serial", "run=x"]
    assert run.run_command(ablation.ABLATE, [*tokens, f"output={tmp_path}"]) == 0
    printed = capsys.readouterr().out
    titles = ["intersection - reasoner: rules", "honest: against full on the", "standoff: against full on the"]
    places = [printed.index(title) for title in titles]
    assert places == sorted(places), "the summary first"
    assert "Each difference is the row minus full on the same seeds." in printed
    assert printed.count("Standoff: one CAV on each leg at once") == 1, "what each suite is"
    assert "level" not in printed.partition("Each difference")[0], "one pair tells nothing"
    folder = tmp_path / "ablate" / "x"
    rows = list(csv.DictReader((folder / "ablation.csv").read_text().splitlines()))
    assert [(row["suite"], row["variant"], row["pairs"]) for row in rows] == [
        ("honest", "full", ""),
        ("honest", "no_safety_check", "1"),
        ("standoff", "full", ""),
        ("standoff", "no_safety_check", "1"),
    ]
    assert {"only_full_succeeds", "mcnemar_p_holm", "clean_difference"} <= rows[0].keys()
    assert (folder / "ablation.md").read_text().startswith("# honest: against full")
    assert (folder / "figures" / "profile.png").stat().st_size > 10_000
