"""Counts are whole numbers in every scenario: half a lane is refused, and so is 4.0 of anything."""

import re

import pytest

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.errors import ConfigError

COUNTS = [
    *((name, "cavs") for name in ("intersection", "roundabout", "highway", "merge")),
    *((name, "lanes") for name in ("highway", "merge")),
]


@pytest.mark.parametrize(("name", "key"), COUNTS)
def test_only_whole_numbers_are_counts(name: str, key: str) -> None:
    node = compose([f"scenario={name}"])["scenario"]
    for value, said in ((2.5, "2.5"), (4.0, "4.0"), ("4", "'4'"), (True, "True")):
        with pytest.raises(ConfigError, match=rf"^scenario\.{key} must be a whole number, got {said}$"):
            build({**node, key: value}, object, "scenario")


@pytest.mark.parametrize("name", ["intersection", "roundabout", "highway", "merge"])
def test_so_are_the_ends_of_the_number_of_drivers(name: str) -> None:
    node = {**compose([f"scenario={name}"])["scenario"], "hdvs": [2, 3.5]}
    with pytest.raises(ConfigError, match=re.escape("scenario.hdvs must be a list with a whole number in each place")):
        build(node, object, "scenario")
