"""What a batch makes of a launcher that loses, invents or repeats an episode, or does not save it."""

import dataclasses
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from typing import Any

import pytest
from toy_models import CLIENTS, BuildAsking, ToyClient, asking_cell, asking_plan
from toy_plan import toy, toy_cell, toy_plan

from codriving.commands import run
from codriving.commands.run import run_experiment
from codriving.datatypes.record import Ending
from codriving.errors import ModelError
from codriving.experiment.batch import HaltedError, drive
from codriving.experiment.launchers import Serial
from codriving.experiment.worker import Report, Unit

CELL = "toy-steady-full"


def altered(alter: Callable[[list[Report]], Iterator[Report]]) -> Serial:
    """A launcher of a user's own, whose reports are not what they should be."""

    class Own(Serial):
        def launch(self, *args: Any, **kwargs: Any) -> Generator[Report, None, None]:
            yield from alter(list(super().launch(*args, **kwargs)))

    return Own()


def loses(*seeds: int) -> Callable[[list[Report]], Iterator[Report]]:
    return lambda reports: (report for report in reports if report.unit.seed not in seeds)


@pytest.mark.parametrize(
    ("alter", "said"),
    [
        (loses(4), f"has lost 1 of 10 episodes: {CELL}, seed 4; "),
        (loses(1, 2, 4), f"has lost 3 of 10 episodes: {CELL}, seed 1, {CELL}, seed 2, {CELL}, seed 4; "),
        (loses(1, 2, 4, 5), f"has lost 4 of 10 episodes: {CELL}, seed 1, {CELL}, seed 2, {CELL}, seed 4 and 1 more; "),
        (lambda reports: iter([]), "has lost 10 of 10 episodes: "),
        (
            lambda reports: iter([*reports, Report(Unit("elsewhere", 3), Ending.SUCCESS)]),
            "reports elsewhere, seed 3, which it was not given or reported before; ",
        ),
        (
            lambda reports: iter([reports[0], *reports]),
            f"reports {CELL}, seed 0, which it was not given or reported before; ",
        ),
    ],
)
def test_what_a_launcher_does_not_give_back_is_named(
    alter: Callable[[list[Report]], Iterator[Report]], said: str, tmp_path: Path
) -> None:
    plan = dataclasses.replace(toy_plan(tmp_path), launcher=altered(alter))
    with pytest.raises(HaltedError) as caught:
        drive(plan, build=toy())
    assert f"the launcher Own {said}" in str(caught.value)
    assert str(caught.value).endswith(f"; 10 of 10 episodes are finished and kept in {tmp_path / 'run' / 'mine'}")
    assert drive(toy_plan(tmp_path), build=toy()).driven == 0


def test_an_episode_that_was_not_saved_is_named_and_the_command_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Idle(Serial):
        def launch(self, units: Any, *args: Any, **kwargs: Any) -> Generator[Report, None, None]:
            yield from super().launch(units[:2], *args, **kwargs)
            yield Report(units[2], Ending.SUCCESS)

    plan = dataclasses.replace(toy_plan(tmp_path), launcher=Idle())
    monkeypatch.setattr(run, "make_plan", lambda points, config_dir: plan)
    monkeypatch.setattr("codriving.experiment.batch.BuildObjects", toy())
    with pytest.raises(ModelError) as caught:
        run_experiment(["scenario=toy", "run=mine"])
    assert str(caught.value) == (
        f"the launcher Idle reports {CELL}, seed 2, which it has not saved; 2 of 10 episodes are finished and kept; "
        "go on with: codriving run scenario=toy run=mine"
    )
    assert drive(toy_plan(tmp_path), build=toy()).driven == 8


def test_of_a_launcher_of_ones_own_no_limit_is_multiplied(tmp_path: Path) -> None:
    launched: list[str] = []

    class Own(Serial):
        asks = False

        def launch(self, units: Any, *args: Any, **kwargs: Any) -> Generator[Report, None, None]:
            launched.extend(unit.cell for unit in units)
            yield from super().launch(units, *args, **kwargs)

    CLIENTS["gpt"] = ToyClient()
    cells = asking_cell(), asking_cell(asks=False)
    assert drive(asking_plan(tmp_path, *cells, episodes=3, launcher=Own()), build=BuildAsking).failed == ()
    assert launched == ["toy-computing-full"] * 3
    CLIENTS["gpt"] = ToyClient()
    (tmp_path / "serial").mkdir()
    plan = asking_plan(tmp_path / "serial", *cells, episodes=3, launcher=Serial())
    assert drive(plan, build=BuildAsking).failed == ()
    assert (CLIENTS["gpt"].most, toy_cell().folder) == (1, CELL)
