"""Thresholds mean the same for every embedder, also for one by which everything is alike."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from remembered import description, experience, filled, interaction

from codriving.datatypes.experience import Description, Experience
from codriving.memory.embedders import Embedder, FeatureEmbedder, Vectors, WordEmbedder, unit
from codriving.memory.snapshot import open_snapshot
from codriving.memory.store import MemoryStore


class Narrow(Embedder):
    """An embedding model by which all texts have a cosine of 0.98 and more, as of several real ones."""

    def __init__(self) -> None:
        super().__init__("litellm narrow", 105)

    def embed(self, descriptions: Sequence[Description]) -> Vectors:
        features = FeatureEmbedder().embed(descriptions)
        return unit(np.hstack([np.full((len(features), 1), 8.0), features.astype(np.float64)]))


def learnt() -> list[Experience]:
    """Nineteen experiences of which four are like another one."""
    kinds = ("crossing", "converging", "weaving")
    told = [description(0.6 * k, kinds[k % 3], ("first", "second")[k % 2], 2.0 + 3 * (k % 4)) for k in range(15)]
    return [experience(one, step=step) for step, one in enumerate([*told, *told[:4]])]


def kept(path: Path, embedder: Embedder) -> Path:
    with MemoryStore(path, embedder, 0.98) as store:
        # In two episodes, so that the second compares with what is in the file.
        store.add(interaction(1), learnt()[:12])
        store.add(interaction(2), learnt()[12:])
    return path


def test_an_embedder_by_which_all_is_alike_merges_what_the_features_merge(tmp_path: Path) -> None:
    vectors = Narrow().embed([e.description for e in learnt()])
    assert (vectors @ vectors.T).min() > 0.98
    theirs = open_snapshot(kept(tmp_path / "n.sqlite", Narrow()), Narrow()).experiences
    ours = open_snapshot(kept(tmp_path / "f.sqlite", FeatureEmbedder()), FeatureEmbedder()).experiences
    assert len(ours) == 15
    assert [entry.count for entry in theirs] == [entry.count for entry in ours] == [2] * 4 + [1] * 11


def test_the_least_similarity_lets_as_large_a_share_through(tmp_path: Path) -> None:
    snapshot = open_snapshot(kept(tmp_path / "n.sqlite", Narrow()), Narrow())
    least = snapshot.equivalent(0.7)
    told = [entry.experience.description for entry in snapshot.experiences]
    upper = np.triu_indices(15, 1)
    theirs, ours = ((vectors @ vectors.T)[upper] for vectors in (Narrow().embed(told), FeatureEmbedder().embed(told)))
    assert 0 < (theirs >= least).sum() == (ours >= 0.7).sum() < len(ours)
    assert 0.98 < least < 1
    # No pair of the file is so alike, so that only what is more alike than any of them is found.
    assert theirs.max() < snapshot.equivalent(0.9999) < 1
    assert snapshot.equivalent(-1.0) == pytest.approx(theirs.min())


def test_without_pairs_it_is_what_was_given(tmp_path: Path) -> None:
    with MemoryStore(tmp_path / "one.sqlite", Narrow(), 0.98) as store:
        store.add(interaction(), learnt()[:1])
    assert open_snapshot(tmp_path / "one.sqlite", Narrow()).equivalent(0.94) == 0.94


def test_thresholds_of_the_embedders_that_they_were_measured_with_stay(tmp_path: Path) -> None:
    assert FeatureEmbedder().calibrated
    assert WordEmbedder().calibrated
    assert not Narrow().calibrated
    snapshot = open_snapshot(filled(tmp_path / "f.sqlite", learnt()), FeatureEmbedder())
    assert snapshot.equivalent(0.94) == pytest.approx(0.94, abs=0.05)
