"""The live picture: arrays as an environment hands them out, without a display."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from crossing import crossing, line, share

from codriving.animation import LivePicture
from codriving.animation.style import ACTIONS, BLUE, GREEN, ORANGE
from codriving.datatypes.record import Ending, Outcome
from codriving.datatypes.world import Action, Intent, Kind, VehicleState, WorldState
from codriving.errors import ConfigError

LANE = ("w", "e", 0)


def world(time: float = 0.0, x: float = -10.0, cavs: tuple[str, ...] = ("CAV1", "CAV2")) -> WorldState:
    """CAVs on their way east, 12 m apart, and HDV1 on its way south."""
    vehicles = [VehicleState(name, Kind.CAV, x - 12 * k, 0.0, 0.0, 9.0, 0.0, LANE) for k, name in enumerate(cavs)]
    vehicles.append(VehicleState("HDV1", Kind.HDV, 0.0, -20.0, np.pi / 2, 5.0, 0.0, ("n", "s", 0)))
    intents = {name: Intent("east", 9.0, LANE) for name in cavs}
    return WorldState(time, round(time * 2), tuple(vehicles), intents, dict.fromkeys(cavs, (Action.IDLE,)))


@pytest.fixture
def picture() -> LivePicture:
    return LivePicture(crossing(), "crossing, seed 3")


def test_a_frame_is_an_array_of_its_own(picture: LivePicture) -> None:
    first = picture.draw(world())
    assert (first.shape, first.dtype) == ((720, 1280, 3), np.uint8)
    kept = first.copy()
    second = picture.draw(world(0.5, -5.0))
    assert (first == kept).all()
    assert (first != second).any()
    assert share(first, BLUE) > 0
    assert share(first, ORANGE) > 0


def test_the_same_calls_give_the_same_pixels(picture: LivePicture) -> None:
    actions = {"CAV1": Action.FASTER}
    twin = LivePicture(crossing(), "crossing, seed 3")
    for time in (0.0, 0.5, 1.0):
        one, other = (p.draw(world(time, time - 10), actions) for p in (picture, twin))
        assert (one == other).all()


@pytest.mark.parametrize("scale", [0.5, 2.0])
def test_any_size(scale: float) -> None:
    small = LivePicture(crossing(), width=700, height=400, scale=scale).draw(world())
    assert small.shape == (400 * scale, 700 * scale, 3)
    road = LivePicture(crossing(), width=300, height=300, scale=scale, panel=False).draw(world())
    assert road.shape == (300 * scale, 300 * scale, 3)
    assert share(road, BLUE) > 0


@pytest.mark.parametrize("changes", [{"width": 500}, {"height": 10}, {"scale": 9.0}, {"width": 99999}, {"scale": 0.0}])
def test_sizes_at_which_nothing_can_be_seen_are_refused(changes: dict[str, Any]) -> None:
    with pytest.raises(ConfigError, match=f"{next(iter(changes))} must be"):
        LivePicture(crossing(), **changes)


def test_actions_and_decisions_are_shown(picture: LivePicture) -> None:
    plain, told = picture.draw(world()), picture.draw(world(), {"CAV1": Action.SLOWER})
    assert share(told, ACTIONS[Action.SLOWER]) > share(plain, ACTIONS[Action.SLOWER])
    full = picture.draw(world(), {"CAV1": Action.SLOWER}, line(0.0))
    assert share(full, "#7a1f5c") > share(told, "#7a1f5c")


def test_who_is_gone_has_arrived(picture: LivePicture) -> None:
    picture.draw(world())
    gone = picture.draw(world(2.0, cavs=("CAV2",)))
    panel = gone[:, 900:]
    assert share(panel, GREEN) > share(picture.draw(world(2.5, cavs=("CAV1", "CAV2")))[:, 900:], GREEN)


def test_the_end_has_a_banner(picture: LivePicture) -> None:
    picture.draw(world())
    end = picture.draw(world(3.0, 25.0), outcome=Outcome(Ending.SUCCESS, 3.0, {"CAV1": 3.0, "CAV2": 3.0}))
    assert share(end[640:710, :896], GREEN) > 0.003


def test_a_reset_chooses_the_view_anew(picture: LivePicture) -> None:
    picture.draw(world())
    picture.draw(world(2.0))
    near = replace(world(), vehicles=world(0.0, 15.0).vehicles[:1])
    fresh = LivePicture(crossing(), "crossing, seed 3").draw(near)
    assert (picture.draw(near) == fresh).all()


def test_a_new_title_is_written(picture: LivePicture) -> None:
    before = picture.draw(world())
    after = picture.draw(world(0.0), title="crossing, seed 4")
    assert (before[:60, 900:1150] != after[:60, 900:1150]).any()


def test_nothing_heavy_is_imported_before_the_first_frame() -> None:
    code = "import sys, codriving.animation; print([m for m in ('matplotlib', 'PIL', 'pygame') if m in sys.modules])"
    root = str(Path(__file__).resolve().parents[2])
    done = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
