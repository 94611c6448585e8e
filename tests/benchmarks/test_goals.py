"""Arithmetic of the tables of speed; nothing is measured here."""

import json
from pathlib import Path
from types import SimpleNamespace

import pytest

from benchmarks import goals, side, speed
from benchmarks.goals import Row, line, show
from benchmarks.options import options


def test_a_share_has_to_be_small_and_a_multiple_large() -> None:
    share = Row("decision", 1.0, 2.0, "ms", 0.5)
    assert (share.ratio, share.reached) == (0.5, True)
    assert not Row("decision", 1.01, 2.0, "ms", 0.5).reached
    multiple = Row("environment", 2.0, 20.0, "ms", 10.0, least=True)
    assert (multiple.ratio, multiple.reached) == (10.0, True)
    assert not Row("environment", 2.01, 20.0, "ms", 10.0, least=True).reached


def test_a_row_says_goal_reached_and_what_was_stored() -> None:
    text = line(Row("decision", 3.0, 2.0, "ms", 0.5), 1.25)
    assert text.split() == ["decision", "3.00", "2.00", "ms", "1.50", "<=", "0.5", "no", "1.25"]


def test_what_is_stored_is_compared_with_the_next_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(goals, "STORED", tmp_path / "stored.json")
    for ours, store in ((1.0, True), (3.0, False), (2.0, False)):
        show("speed", "0.1", [Row("decision", ours, 2.0, "ms", 0.5)], as_json=True, store=store)
    seen = [json.loads(text)["speed"][0] for text in capsys.readouterr().out.splitlines()]
    assert [(row["ratio"], row["stored"]) for row in seen] == [(0.5, None), (1.5, 0.5), (1.0, 0.5)]
    assert json.loads((tmp_path / "stored.json").read_text()) == {"decision": 0.5}


def test_no_checkout_is_compared_with(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    speed.main([])
    assert "--against CHECKOUT" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        options(["--against", str(tmp_path)])
    assert options(["--against", str(side.THIS)]).against == side.THIS


class _Toy:
    """Environment and method in one: three decisions."""

    road_map = driving_model = None

    def __init__(self) -> None:
        self.seen: list[object] = []
        self.outcome: str | None = None

    def reset(self, *given: object) -> int:
        self.seen.append(given)
        return 0

    def act(self, state: int) -> SimpleNamespace:
        return SimpleNamespace(actions=state + 1)

    def step(self, actions: int) -> int:
        self.seen.append(actions)
        self.outcome = "over" if actions == 3 else None
        return actions


def test_a_side_times_each_decision_and_each_step() -> None:
    toy = _Toy()
    taken = side.answer(SimpleNamespace(environment=toy, method=toy), 7)
    assert toy.seen == [(7,), (None, None, 7), 1, 2, 3]
    assert {name: len(times) for name, times in taken.items()} == {"decisions": 3, "steps": 3}
