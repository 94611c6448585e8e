"""Whole frames: the same moment always gives the same pixels, and everything asked for is on it."""

from dataclasses import replace

import numpy as np
import pytest
from crossing import Frame, crossing, episode, line, share

from codriving.animation.canvas import Canvas
from codriving.animation.film import EpisodeFilm
from codriving.animation.panel import natural
from codriving.animation.picture import sentence
from codriving.animation.style import ASPHALT, BLUE, GREEN, GROUND, INK, ORANGE, PANEL, PAPER, VERMILION
from codriving.datatypes.record import Collision, Ending, EpisodeRecord, FlowLog, Outcome

TRAJECTORY, OUTCOME = episode()
ROAD = 1280 - round(PANEL)


def screening(outcome: Outcome = OUTCOME, scale: float = 1.0) -> EpisodeFilm:
    record = EpisodeRecord("crossing", "codriving", "full", "rules", 7, outcome, None, (), 2, {})
    return EpisodeFilm(crossing().road, TRAJECTORY, [line(0.0), line(1.0)], record, scale)


@pytest.fixture(scope="module")
def shown() -> EpisodeFilm:
    return screening()


def test_a_frame_is_the_same_whatever_was_drawn_before(shown: EpisodeFilm) -> None:
    first = {time: shown.frame(time).copy() for time in (0.0, 0.5, 1.7, 3.0)}
    fresh = screening()
    for time in (3.0, 0.5, 1.7, 0.0):
        assert (fresh.frame(time) == first[time]).all(), time
    assert (screening().frame(1.7) == first[1.7]).all()


def test_everything_is_on_it(shown: EpisodeFilm) -> None:
    frame = shown.frame(0.2)
    road, panel = frame[:, :ROAD], frame[:, ROAD:]
    assert share(road, GROUND) > 0.3
    assert share(road, ASPHALT) > 0.03
    for colour in (BLUE, ORANGE, "#7a1f5c"):
        assert share(road, colour) > 0.0001, colour
    assert share(panel, PAPER) > 0.7
    assert share(panel, INK, 40) > 0.003
    assert (frame[..., 3] == 255).all()


def test_the_conflict_is_gone_once_one_of_the_two_has_left(shown: EpisodeFilm) -> None:
    bands = [share(shown.frame(time)[:, :ROAD], "#7a1f5c") for time in (0.0, 3.0)]
    assert bands[0] > 0
    without = replace(TRAJECTORY, tracks=TRAJECTORY.tracks[:2])
    record = EpisodeRecord("crossing", "codriving", "full", "rules", 7, OUTCOME, None, (), 2, {})
    alone = EpisodeFilm(crossing().road, without, [line(0.0)], record)
    assert share(alone.frame(0.0)[:, :ROAD], "#7a1f5c") == 0


def test_the_panel_follows_the_decisions(shown: EpisodeFilm) -> None:
    record = EpisodeRecord("crossing", "codriving", "full", "rules", 7, OUTCOME, None, (), 2, {})
    other = line(0.0)
    other["cavs"][1]["action"] = "IDLE"
    changed = EpisodeFilm(crossing().road, TRAJECTORY, [other], record)
    assert share(shown.frame(0.0)[:, ROAD:], VERMILION) > 0
    assert share(changed.frame(0.0)[:, ROAD:], VERMILION) == 0


def test_the_end_has_a_banner(shown: EpisodeFilm) -> None:
    before, after = (shown.frame(time)[:, :ROAD].copy() for time in (2.9, 3.0))
    foot = slice(640, 710)
    assert share(after[foot], GREEN) > share(before[foot], GREEN) + 0.003
    hit = Outcome(Ending.COLLISION, 3.0, {"CAV1": 2.0}, Collision(3.0, "CAV2", "HDV1", "CAV-HDV"))
    crashed = screening(hit).frame(3.0)[:, :ROAD]
    assert share(crashed[foot], VERMILION) > 0.003
    assert share(crashed[:600], VERMILION) > share(after[:600], VERMILION)


@pytest.mark.parametrize(
    ("outcome", "words"),
    [
        (OUTCOME, "Success: all 2 CAVs arrived after 3.0 s"),
        (Outcome(Ending.TIMEOUT, 50.0, {"CAV1": 2.0}), "Timeout after 50.0 s; 1 of 2 CAVs arrived"),
        (Outcome(Ending.OFF_ROAD, 4.0, {}, off_road=("CAV1",)), "CAV1 left the road after 4.0 s; 0 of 2 CAVs arrived"),
        (Outcome(Ending.ERROR, 4.0, {}, message="ValueError: no"), "Error after 4.0 s: ValueError: no"),
        (
            Outcome(Ending.COLLISION, 4.0, {}, Collision(4.0, "CAV1", "HDV2", "CAV-HDV")),
            "Collision: CAV1 ran into HDV2 after 4.0 s; 0 of 2 CAVs arrived",
        ),
    ],
)
def test_the_banner_says_how_it_ended(outcome: Outcome, words: str) -> None:
    assert sentence(outcome, 2) == words


def test_at_twice_the_scale_it_is_the_same_picture_and_crisper(shown: EpisodeFilm) -> None:
    once = shown.frame(0.2)[..., :3].astype(float)
    twice = screening(scale=2.0).frame(0.2)[..., :3].astype(float)
    assert twice.shape == (1440, 2560, 3)
    assert np.abs(twice.reshape(720, 2, 1280, 2, 3).mean((1, 3)) - once).mean() < 3.0


def test_vehicles_move_by_less_than_a_pixel_a_frame_where_they_should() -> None:
    """No jitter: between two close moments every pixel changes a little or not at all."""
    canvas = Canvas(100, 100)
    frames: list[Frame] = []
    for x in (50.0, 50.2):
        canvas.fill("#ffffff")
        canvas.polygon([(x - 10, 40), (x + 10, 40), (x + 10, 60), (x - 10, 60)], "#000000")
        frames.append(canvas.pixels.astype(int))
    edge = np.abs(frames[1] - frames[0]).max()
    assert 30 < edge < 70


def test_of_a_flow_the_panel_shows_who_is_on_the_road() -> None:
    """After 2 s CAV1 is gone; an episode keeps its card with a tick, a flow has too many for that."""
    flow = screening(Outcome(Ending.COUNTED, 3.0, OUTCOME.arrivals, flow=FlowLog(0.0, 0.1, (), ())))
    before, after = (flow.frame(time)[:, ROAD:].copy() for time in (1.9, 2.5))
    assert share(before, BLUE) > share(after, BLUE) > 0
    assert share(after, GREEN) < share(screening().frame(2.5)[:, ROAD:], GREEN)


def test_the_end_of_a_flow_in_words() -> None:
    flow = Outcome(Ending.COUNTED, 150.0, {"CAV1a": 20.0, "HDV1b": 30.0}, flow=FlowLog(30.0, 0.1, (), ()))
    assert sentence(flow, 0) == "The window is over after 150.0 s; 2 vehicles have left"


def test_names_are_ordered_as_people_do() -> None:
    assert sorted(["CAV10a", "CAV2a", "CAV2", "CAV10", "CAV1b"], key=natural) == [
        *("CAV1b", "CAV2", "CAV2a", "CAV10", "CAV10a"),
    ]
