"""Harder scenes from the command line to the record: what is asked for is driven, and what does not fit is refused."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from codriving.cli.app import app

SHORT = ("episodes=1", "seed=10000", "launcher=serial", "method=pidm", "scenario.time_limit=2", "run=short")
PARTICIPANT = {"id", "kind", "route", "arrived", "style"}


def run(*args: str) -> Result:
    return CliRunner().invoke(app, ["run", *args])


def participants(folder: Path) -> list[dict[str, str]]:
    (record,) = folder.glob("outputs/run/short/episodes/*/10000/record.json")
    found: list[dict[str, str]] = json.loads(record.read_text(encoding="utf-8"))["participants"]
    assert all(set(one) == PARTICIPANT for one in found)
    return found


@pytest.mark.parametrize("scenario", ["intersection", "roundabout"])
def test_one_by_each_leg_and_an_exit_that_is_blocked(
    scenario: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = run(
        *SHORT,
        f"scenario={scenario}",
        "scenario.pattern=standoff",
        "scenario.cavs=8",
        "scenario.row_gap=15",
        "scenario.cav_speed=[8,8]",
        "scenario.turns=[left,straight]",
        "scenario.blocked_exit=20",
        "scenario.blocked_room=6",
        "drivers=rough",
        "limits=road",
    )
    assert result.exit_code == 0, result.output
    found = participants(tmp_path)
    legs = [one["route"].split("-")[0] for one in found if one["kind"] == "CAV"]
    assert sorted(legs[:4]) == sorted(legs[4:]) == ["east", "north", "south", "west"]
    assert [one["style"] for one in found].count("blocker") == 1
    assert found[-1]["style"] == "blocker"


def test_blind_corners(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    result = run(*SHORT, "scenario.blind=8", "drivers=mixed", "render=true")
    assert result.exit_code == 0, result.output
    assert len(participants(tmp_path)) >= 6
    manifest = (tmp_path / "outputs" / "run" / "short" / "manifest.json").read_text(encoding="utf-8")
    assert '"scenario.blind": "8"' in manifest
    assert "scenario.pattern" not in manifest
    frame = CliRunner().invoke(app, ["replay", "short", "--frame", "1", "--out", "frame.png"])
    assert frame.exit_code == 0, frame.output


@pytest.mark.parametrize(
    "asked",
    [
        ("scenario=merge", "scenario.hdvs=[8,8]", "scenario.ramp_hdvs=0.5"),
        ("scenario=highway", "scenario.hdvs=[16,16]"),
    ],
)
def test_more_human_drivers_on_roads_with_lanes(
    asked: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = run(*SHORT, *asked)
    assert result.exit_code == 0, result.output
    number = int(asked[1].removeprefix("scenario.hdvs=[").split(",")[0])
    assert sum(one["kind"] == "HDV" for one in participants(tmp_path)) == number


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ("scenario.pattern=circle", "scenario.pattern must be one of random, standoff, got 'circle'"),
        (
            "scenario.turns=[left,back]",
            "scenario.turns must be a list, each one of left, straight, right, got ['left', 'back']",
        ),
        (
            "scenario.turns=[]",
            "scenario.turns must name one or more of left, straight, right, each once, got []",
        ),
        ("scenario.blocked_exit=soon", "scenario.blocked_exit must be a number, got 'soon'"),
        ("scenario.blocked_exit=700", "scenario.blocked_exit must be 0 to 600 s, got 700"),
        ("scenario.blind=5", "scenario.blind must be 7 to 100 m, got 5"),
        ("scenario.blind=near", "scenario.blind must be a number or null, got 'near'"),
        ("scenario=roundabout,scenario.blind=8", "unknown key scenario.blind"),
        ("scenario=merge,scenario.pattern=standoff", "unknown key scenario.pattern"),
        ("scenario=highway,scenario.blocked_exit=20", "unknown key scenario.blocked_exit"),
        (
            "scenario.pattern=standoff,scenario.cavs=8,scenario.row_gap=8",
            "scenario.row_gap 8 m leaves CAVs that start at 5 m/s or more no room to brake; use 11 m or more",
        ),
        (
            "scenario=merge,scenario.cavs=10,scenario.hdvs=[20;20]",
            "scenario: 10 CAVs and up to 20 HDVs cannot start within 5 to 130 m along 2 main lanes and the ramp, where",
        ),
    ],
)
def test_what_does_not_fit_is_one_line(
    asked: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    overrides = asked.split(",scenario.")
    tokens = [token if k == 0 else f"scenario.{token}" for k, token in enumerate(overrides)]
    result = run(*SHORT, *(token.replace(";", ",") for token in tokens))
    assert result.exit_code == 2
    lines = [line for line in result.stderr.splitlines() if line]
    assert len(lines) == 1, result.stderr
    assert message in lines[0]
    assert not list(tmp_path.glob("outputs/run/short/episodes/*"))
