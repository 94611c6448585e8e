"""Trained weights: what is written is read, and everything that they are not for is refused."""

import json
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

from codriving.errors import WeightsError
from codriving.methods.learned.layout import FAMILIES, JUNCTION, LANES, VERSION, feature_count
from codriving.methods.learned.network import Network
from codriving.methods.learned.weights import Purpose, Trained, load, save, shipped, sidecar

FAR = 7.0
NEAR = 4.5

PURPOSE = Purpose(
    method="madqn",
    family=JUNCTION,
    features=VERSION,
    near=NEAR,
    far=FAR,
    decision_interval=0.5,
    target_speeds=((0.0, 3.0, 6.0, 9.0),),
    actions=("SLOWER", "IDLE", "FASTER"),
    hidden=(5,),
    training={"seed": 1},
)


def trained(seed: int = 0) -> Trained:
    rng = np.random.default_rng(seed)
    sizes = (feature_count(JUNCTION), 5, 3)
    weights = [rng.normal(size=pair).astype(np.float32) for pair in pairwise(sizes)]
    return Trained(Network(weights, [rng.normal(size=n).astype(np.float32) for n in sizes[1:]]), PURPOSE)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Written weights."""
    save(tmp_path / "some.safetensors", trained())
    return tmp_path / "some.safetensors"


def test_what_is_written_is_read(file: Path) -> None:
    found, wanted = load(file), trained()
    assert found.purpose == wanted.purpose
    for one, other in zip(
        (*found.network.weights, *found.network.biases), (*wanted.network.weights, *wanted.network.biases), strict=True
    ):
        np.testing.assert_array_equal(one, other)


def test_weights_say_in_which_world_they_were_trained_and_old_ones_were_trained_in_the_first(file: Path) -> None:
    there = {"limits": "road", "drivers": "rough"}
    save(file, replace(trained(), purpose=replace(PURPOSE, world=there)))
    assert load(file).purpose.world == there
    text = json.loads(sidecar(file).read_text(encoding="utf-8"))
    del text["world"]
    sidecar(file).write_text(json.dumps(text), encoding="utf-8")
    assert load(file).purpose.world == {"limits": "none", "drivers": "simulator"}


def test_the_same_weights_are_the_same_bytes(file: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.safetensors"
    save(again, trained())
    assert again.read_bytes() == file.read_bytes()
    assert sidecar(again).read_bytes() == sidecar(file).read_bytes()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"features": VERSION + 1}, "features of version"),
        ({"near": 9.0}, "features of version"),
        ({"family": "rivers"}, "rivers"),
        ({"actions": ["FASTER", "IDLE", "SLOWER"]}, "other actions"),
        ({"hidden": [7]}, "W0 is"),
        ({"hidden": None}, "does not describe"),
        ({"target_speeds": [["fast"]]}, "does not describe"),
    ],
)
def test_a_sidecar_of_something_else_is_refused(file: Path, change: dict[str, Any], words: str) -> None:
    side = sidecar(file)
    side.write_text(json.dumps({**json.loads(side.read_text()), **change}))
    with pytest.raises(WeightsError, match=words):
        load(file)


def cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:-20])


def transposed(file: Path) -> None:
    save_file({name: np.ascontiguousarray(tensor.T) for name, tensor in load_file(file).items()}, file)


def infinite(file: Path) -> None:
    save_file({name: np.full_like(tensor, np.inf) for name, tensor in load_file(file).items()}, file)


def one_missing(file: Path) -> None:
    tensors = load_file(file)
    del tensors["b1"]
    save_file(tensors, file)


def no_json(file: Path) -> None:
    sidecar(file).write_text("{")


@pytest.mark.parametrize("damage", [cut, transposed, infinite, one_missing, no_json, Path.unlink])
def test_damaged_files_are_refused_in_a_line(file: Path, damage: Callable[[Path], None]) -> None:
    damage(file)
    with pytest.raises(WeightsError, match="some"):
        load(file)


@pytest.mark.parametrize(
    ("family", "speeds", "interval", "words"),
    [
        (LANES, (0.0, 3.0, 6.0, 9.0), 0.5, "this road is one of lanes"),
        (JUNCTION, (0.0, 3.0, 6.0, 9.0), 0.2, "scenario.decision_frequency=2"),
        (JUNCTION, (0.0, 4.5, 9.0), 0.5, "step of target speeds"),
        (JUNCTION, (0.0, 3.0, 6.0), 0.5, "highest target speed"),
    ],
)
def test_another_road_is_refused(family: str, speeds: tuple[float, ...], interval: float, words: str) -> None:
    with pytest.raises(WeightsError, match=words):
        PURPOSE.check(family, speeds, interval)


def test_grids_between_those_that_were_driven_with_are_accepted() -> None:
    several = replace(PURPOSE, target_speeds=((0.0, 3.0, 6.0, 9.0), (0.0, 5.0, 10.0, 15.0)))
    for speeds in ((0.0, 3.0, 6.0, 9.0), (0.0, 4.0, 8.0, 12.0), (5.0, 10.0, 15.0)):
        several.check(JUNCTION, speeds, 0.5)


@pytest.mark.parametrize("limited", [True, False])
@pytest.mark.parametrize("family", FAMILIES)
def test_shipped_weights_are_small_and_were_validated(family: str, limited: bool) -> None:
    file = shipped("madqn", family, limited)
    purpose = load(file).purpose
    assert purpose.family == family
    assert purpose.training["command"].startswith("codriving train madqn")
    assert purpose.training["validation"]["first_seed"] >= 10_000
    assert purpose.training["validation"]["score"] > 0.5
    curve = file.with_suffix(".csv").read_text().splitlines()
    assert curve[0].startswith("decisions,")
    assert any(line.startswith(f"{purpose.training['decisions']},") for line in curve), "the state that was chosen"
    assert file.stat().st_size < 200_000
