"""What a method asked and counted is noted with the episode, also where it breaks off."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import pytest
from toy_drive import LABELS, ToyDeliberation, ToyEnvironment, ToyMethod, ToyMetrics

from codriving.datatypes.world import WorldState
from codriving.experiment.episode import EpisodeResult, run_episode
from codriving.experiment.worker import SaveEpisode, Unit
from codriving.metrics.scorer import Scorer
from codriving.runs.episode_folder import TRANSCRIPT, read_record, read_transcript


@dataclass(frozen=True)
class Said(ToyDeliberation):
    """A step in which a model was asked."""

    counts: Mapping[str, float] = field(default_factory=lambda: {"model_calls": 2, "cost_usd": 0.25})
    transcript: tuple[dict[str, Any], ...] = ()


@dataclass
class Asking(ToyMethod):
    """Asks a model in every step; the broken step has been paid for as well."""

    unfinished: bool = True

    def act(self, world: WorldState) -> Said:
        """One line a step."""
        done = super().act(world)
        return Said(done.actions, done.step, transcript=({"time": world.time, "text": "Bearer canary-key"},))

    def unfinished_step(self, time: float) -> tuple[dict[str, float], list[dict[str, Any]]]:
        """What was asked before it broke."""
        if not self.unfinished:
            raise RuntimeError("broken as well")
        return {"model_calls": 1, "cost_usd": 0.5}, [{"time": time, "text": "last"}]


def drive(method: ToyMethod) -> EpisodeResult:
    return run_episode(ToyEnvironment(), method, {"toy": Scorer(ToyMetrics(), {})}, 3, LABELS)


def test_a_transcript_is_the_lines_of_all_steps() -> None:
    result = drive(Asking())
    steps = result.record.decisions
    assert [line["time"] for line in result.transcript] == [float(k) for k in range(steps)]
    assert result.record.counts == {"cost_usd": 0.25 * steps, "model_calls": 2 * steps}
    assert type(result.record.counts["model_calls"]) is int


def test_a_method_that_asks_nothing_has_none() -> None:
    assert drive(ToyMethod()).transcript == ()
    assert drive(ToyMethod(raises=(3,))).record.counts == {"fallbacks": 1}


@pytest.mark.parametrize(("unfinished", "cost", "lines"), [(True, 0.75, 2), (False, 0.25, 1)])
def test_the_step_that_broke_off_has_been_paid_for(unfinished: bool, cost: float, lines: int) -> None:
    result = drive(Asking(raises=(3,), unfinished=unfinished))
    assert result.record.outcome.message.startswith("RuntimeError: seed 3")
    assert result.record.counts["cost_usd"] == cost
    assert [line["time"] for line in result.transcript] == [0.0, 1.0][:lines]


def test_the_transcript_is_kept_without_keys(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TOY_KEY", "canary-key")
    SaveEpisode(tmp_path, ("TOY_KEY",))(Unit("cell", 3), drive(Asking()))
    folder = tmp_path / "episodes" / "cell" / "3"
    assert {line["text"] for line in read_transcript(folder)} == {"Bearer <redacted>"}
    assert read_record(folder).counts["cost_usd"] > 0
    SaveEpisode(tmp_path, ("TOY_KEY",))(Unit("cell", 3), drive(ToyMethod()))
    assert not (folder / TRANSCRIPT).exists()


def test_what_a_server_said_cannot_harm_a_table() -> None:
    @dataclass
    class Rude(ToyMethod):
        def act(self, world: WorldState) -> Said:
            raise RuntimeError("\x1b[31mred\u202e \ud800\n gone")

    assert drive(Rude()).record.outcome.message == "RuntimeError: [31mred gone"
