"""What is built once lies outside of the garbage collector while a batch drives, and not for longer."""

import gc
from collections.abc import Generator
from pathlib import Path

import pytest
from toy_plan import toy, toy_plan

from codriving.config.compose import compose
from codriving.experiment.batch import drive
from codriving.experiment.objects import BuildObjects, given_back
from codriving.experiment.worker import Objects

Configs = dict[str, dict[str, object]]


@pytest.fixture(autouse=True)
def collected() -> Generator[None]:
    """All is in the hands of the collector before and after."""
    gc.unfreeze()
    yield
    gc.unfreeze()


def test_what_is_built_is_not_looked_through_again() -> None:
    objects = BuildObjects({"cell": compose(["scenario=merge"])})("cell")
    seen = {id(item) for item in gc.get_objects()}
    assert id(objects.environment) not in seen
    taken = gc.get_freeze_count()
    BuildObjects({"cell": compose(["scenario=merge"])})("cell")
    assert gc.get_freeze_count() <= taken


def test_a_batch_gives_back_what_it_took(tmp_path: Path) -> None:
    counts = []

    def build(configs: Configs) -> "Freezing":
        return Freezing(configs, counts)

    drive(toy_plan(tmp_path), build=build)
    assert counts
    assert min(counts) > 0
    assert gc.get_freeze_count() == 0


def test_what_was_taken_before_stays_taken() -> None:
    gc.freeze()
    with given_back():
        pass
    assert gc.get_freeze_count() > 0


class Freezing:
    """Builds toys as real objects are built."""

    def __init__(self, configs: Configs, counts: list[int]) -> None:
        self._build, self._counts = toy()(configs), counts

    def __call__(self, cell: str) -> Objects:
        gc.freeze()
        self._counts.append(gc.get_freeze_count())
        return self._build(cell)
