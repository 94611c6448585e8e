"""Retrieval: situations of the same kind are found far more often than by chance, and better than by words alone."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from driven import drive
from remembered import description
from worlds import FULL, Junction

from codriving.datatypes.experience import Description
from codriving.environment.environment import Environment
from codriving.llm.language_model import Offline
from codriving.memory.describe import describe
from codriving.memory.embedders import FeatureEmbedder, WordEmbedder
from codriving.memory.retrieval_metrics import chance, precision_at, same_kind
from codriving.methods.codriving import CoDriving
from codriving.reasoning.sharing.sharing import CdaLevel

KEPT, HELD_BACK = (10_001, 10_002, 10_003), (10_004, 10_005)


@pytest.fixture(scope="module")
def told(configured: Callable[..., Environment]) -> tuple[list[Description], list[Description]]:
    """What CAVs were told in some episodes, and in some others that are held back."""
    world = Junction(configured("scenario=intersection"))
    made = CoDriving(CdaLevel(**FULL), Offline(), None, 1.5)

    def situations(seeds: tuple[int, ...]) -> list[Description]:
        steps = [step for seed in seeds for step in drive(world.environment, made, seed).steps]
        return [describe(s) for step in steps for s in step.situations if s.conflicts]

    return situations(KEPT), situations(HELD_BACK)


def test_the_default_finds_the_same_kind_far_better_than_chance(
    told: tuple[list[Description], list[Description]],
) -> None:
    blind = chance(*told)
    found = precision_at(FeatureEmbedder(), *told, (1, 5))
    words = precision_at(WordEmbedder(), *told, (1, 5))
    assert blind < 0.25
    for k in (1, 5):
        assert found[k] > 0.6
        assert found[k] > 2.5 * blind
        assert found[k] > words[k] > blind


@pytest.mark.parametrize(
    ("change", "alike"),
    [
        ({}, True),
        ({"dttcp": 2.9}, True),
        ({"dttcp": 3.2}, False),
        ({"relation": "weaving"}, False),
        ({"order": "first"}, False),
        ({"speed": 1.0}, True),
    ],
)
def test_what_counts_as_the_same_kind(change: dict[str, float], alike: bool) -> None:
    one, other = description(dttcp=2.0), description(**{"dttcp": 2.0, **change})
    assert same_kind(one, other) is same_kind(other, one) is alike


def test_situations_without_a_conflict_are_of_one_kind() -> None:
    none = description(relation="none")
    assert same_kind(none, description(relation="none", speed=2.0))
    assert not same_kind(none, description())


def test_precision_of_what_is_there_itself_is_perfect() -> None:
    kept = [description(dttcp=4.0 * k) for k in range(4)]
    assert precision_at(FeatureEmbedder(), kept, kept, (1,)) == {1: 1.0}
    assert chance(kept, kept) == 0.25
    assert (
        precision_at(FeatureEmbedder(), kept, [replace(kept[0], kinds={**kept[0].kinds, "order": "none"})], (1, 4))[4]
        == 0
    )
