"""Embedders: vectors of length 1, the same every time, whose cosine falls as situations differ more."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from remembered import description

from codriving.errors import ConfigError
from codriving.memory.embedders import (
    NUMBERS,
    OWN,
    Embedder,
    EmbeddingServer,
    FeatureEmbedder,
    WordEmbedder,
    make_embedder,
)

SERVER = EmbeddingServer("openai/none", None, None, 1.0)
EMBEDDERS = [FeatureEmbedder(), WordEmbedder(), WordEmbedder(banded=False)]


def likeness(embedder: Embedder, **change: float) -> float:
    one, other = embedder.embed([description(dttcp=2.0), description(**{"dttcp": 2.0, **change})])
    return float(one @ other)


@pytest.mark.parametrize("embedder", EMBEDDERS, ids=lambda e: e.name)
def test_vectors_have_length_one_and_repeat(embedder: Embedder) -> None:
    told = [description(), description(relation="none"), description(dttcp=7.0, speed=0.0)]
    once, again = embedder.embed(told), embedder.embed(told)
    assert once.dtype == np.float32
    assert once.shape == (3, embedder.dimension)
    assert np.linalg.norm(once, axis=1) == pytest.approx(np.ones(3), abs=1e-6)
    assert once.tobytes() == again.tobytes()
    assert embedder.embed([]).shape == (0, embedder.dimension)


@settings(deadline=None)
@given(st.floats(0, 15), st.floats(0.05, 5), st.floats(0.05, 5))
def test_a_larger_difference_is_less_alike(dttcp: float, near: float, further: float) -> None:
    embed = FeatureEmbedder().embed
    told = [description(), *(description(mine=20.0, its=20.0, my_ttcp=2.5, its_ttcp=2.5, later=0.0) for _ in range(3))]
    values = (dttcp, dttcp + near, dttcp + near + further)
    told = [replace(d, numbers={**d.numbers, "dttcp": v}) for d, v in zip(told[1:], values, strict=True)]
    one, two, three = embed(told)
    assert one @ two > one @ three - 1e-6


@pytest.mark.parametrize("change", [{"relation": "weaving"}, {"order": "first"}, {"speed": 1.0}, {"dttcp": 6.0}])
def test_what_matters_lowers_the_likeness(change: dict[str, float]) -> None:
    assert likeness(FeatureEmbedder(), **change) < 0.97
    assert likeness(FeatureEmbedder()) == pytest.approx(1.0, abs=1e-6)


def test_a_number_that_is_not_there_is_no_zero() -> None:
    alone, led = FeatureEmbedder().embed([description(), description(lead_gap=0.0)])
    assert alone @ led < 1 - 1e-3


def test_every_number_of_a_description_has_a_place() -> None:
    names = [number.name for number in NUMBERS]
    assert len(set(names)) == len(names)
    for name in names:
        one, other = FeatureEmbedder().embed([description(**{name: 0.5}), description(**{name: 1.0})])
        assert not np.array_equal(one, other), name


def test_words_in_bands_do_not_tell_near_numbers_apart_and_plain_ones_do() -> None:
    near = [replace(description(), scene=f"Driving {speed:.1f} m/s.") for speed in (8.1, 8.4)]
    far = [replace(description(), scene=f"Driving {speed:.1f} m/s.") for speed in (8.1, 1.4)]
    for told, alike in ((near, True), (far, False)):
        one, other = WordEmbedder().embed(told)
        assert np.array_equal(one, other) is alike
    one, other = WordEmbedder(banded=False).embed(near)
    assert not np.array_equal(one, other)


@pytest.mark.parametrize("name", OWN)
def test_own_embedders_by_name(name: str) -> None:
    assert make_embedder(name, SERVER).name.startswith(name)


def test_an_unknown_embedder_is_refused_with_the_choices() -> None:
    with pytest.raises(ConfigError, match="embedder must be one of features, words, litellm, got 'glove'"):
        make_embedder("glove", SERVER)
    with pytest.raises(ConfigError, match="embedding_deadline must be"):
        make_embedder("litellm", EmbeddingServer("openai/x", None, None, 0.0))
    with pytest.raises(ConfigError, match="embedding_model must be"):
        make_embedder("litellm", EmbeddingServer(" ", None, None, 1.0))
    with pytest.raises(ConfigError, match="embedding_api_base must be"):
        make_embedder("litellm", EmbeddingServer("openai/x", "localhost", None, 1.0))
