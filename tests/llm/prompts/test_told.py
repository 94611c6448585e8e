"""Reasons without the times that rot, how long one waits for another, and whom human drivers keep out."""

from math import inf

import pytest

from codriving.datatypes.order import ApproachingVehicle, Instance
from codriving.llm.prompts.free_text import Names
from codriving.llm.prompts.told import BlockView, blocks, timeless, waits


@pytest.mark.parametrize(
    ("reason", "told"),
    [
        ("CAV1 can be there earlier (3.1 s against 4.2 s)", "CAV1 can be there earlier"),
        ("a human driver may use the zone until 6.3 s from now", "a human driver may use the zone"),
        ("CAV1 arrives in 3.2 s, earlier than CAV3 at 4.0 seconds", "CAV1 arrives, earlier than CAV3"),
        ("the CAV is through (-0.3 s) before it can be there", "the CAV is through before it can be there"),
        ("CAV2 (a truck) drives 8 m/s and cannot stop", "CAV2 (a truck) drives 8 m/s and cannot stop"),
        ("own estimate: 3.1 s against 4.0 s for CAV2", "own estimate: 3.1 s against 4.0 s for CAV2"),
        ("", ""),
    ],
)
def test_times_are_left_out(reason: str, told: str) -> None:
    assert timeless(reason) == told


@pytest.mark.parametrize(
    ("etas", "expected"),
    [
        ((3.0, 4.0), (1.5, 2.8)),
        ((3.0, 9.0), (0.0, 7.8)),
        ((-1.0, 2.0), (0.5, 3.8)),  # The first is past the beginning of its zone
        ((2.0, -1.0), (4.5, 0.0)),
    ],
)
def test_one_waits_until_the_other_has_left(etas: tuple[float, float], expected: tuple[float, float]) -> None:
    vehicles = {name: ApproachingVehicle(name, 50.0, eta) for name, eta in zip(("A", "B"), etas, strict=True)}
    instance = Instance(0.0, vehicles, {("A", "B"): 2.5, ("B", "A"): 1.8}, frozenset())
    assert waits(instance, "A", "B") == pytest.approx(expected)


def test_drivers_keep_out_give_way_or_are_past() -> None:
    passages = {
        "CAV2": {"HDV1": (-1.0, 3.0), "HDV2": (inf, inf)},
        "CAV1": {"HDV1": (2.0, 5.0), "HDV3": (-4.0, -1.0)},
    }
    assert blocks(passages, {"HDV1": 7.0, "HDV2": 6.0}, Names(["CAV1", "CAV2", "HDV1", "HDV2", "HDV3"])) == [
        BlockView("HDV1", 7.0, (("CAV1", 2.0, 5.0), ("CAV2", 0.0, 3.0)), ()),
        BlockView("HDV2", 6.0, (), ("CAV2",)),
        BlockView("HDV3", 0.0, (), ()),
    ]
