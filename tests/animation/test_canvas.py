"""The sheet: lines, shapes, letters, and words made to fit."""

import numpy as np
import pytest
from crossing import colour_at, is_colour, share
from hypothesis import given
from hypothesis import strategies as st

from codriving.animation.canvas import Canvas, Shape, shortened, wrapped

SQUARE = [(20.0, 20.0), (60.0, 20.0), (60.0, 60.0), (20.0, 60.0)]


@pytest.fixture
def canvas() -> Canvas:
    sheet = Canvas(100, 80)
    sheet.fill("#ffffff")
    return sheet


def test_y_grows_downwards(canvas: Canvas) -> None:
    canvas.polygon([(0, 0), (100, 0), (100, 20), (0, 20)], "#0072b2")
    assert colour_at(canvas.pixels, 50, 5) == (0, 0x72, 0xB2)
    assert colour_at(canvas.pixels, 50, 40) == (255, 255, 255)


def test_scale_makes_real_pixels_of_logical_ones() -> None:
    sheet = Canvas(100, 80, 2.0)
    sheet.fill("#ffffff")
    sheet.polygon(SQUARE, "#d55e00")
    assert sheet.pixels.shape == (160, 200, 4)
    assert is_colour(sheet.pixels, 2 * 40, 2 * 40, "#d55e00")
    assert is_colour(sheet.pixels, 2 * 62, 2 * 40, "#ffffff")
    assert share(sheet.pixels, "#d55e00") == pytest.approx(40 * 40 / (100 * 80), rel=0.02)


def test_parts_of_one_shape_that_overlap_leave_no_hole(canvas: Canvas) -> None:
    other = [(x + 20, y) for x, y in SQUARE]
    canvas.shape(Shape([SQUARE, other], closed=True), None, "#009e73")
    assert is_colour(canvas.pixels, 50, 40, "#009e73")


def test_a_matrix_moves_a_shape(canvas: Canvas) -> None:
    matrix = np.array([[2.0, 0.0, 10.0], [0.0, 2.0, 5.0], [0.0, 0.0, 1.0]])
    canvas.shape(Shape([[(0, 0), (10, 0), (10, 10), (0, 10)]], closed=True), matrix, "#009e73")
    assert is_colour(canvas.pixels, 28, 23, "#009e73")
    assert is_colour(canvas.pixels, 5, 5, "#ffffff")


def test_dashes_leave_gaps(canvas: Canvas) -> None:
    canvas.line([(0, 40), (100, 40)], "#000000", 4.0, (10.0, 10.0))
    row = canvas.pixels[40, :, 0] < 128
    assert 0.4 < row.mean() < 0.6


def test_nothing_is_drawn_outside_a_clip(canvas: Canvas) -> None:
    with canvas.within(30, 10, 20, 20):
        canvas.polygon([(0, 0), (100, 0), (100, 80), (0, 80)], "#000000")
        canvas.text(0, 20, "WWWWWWWWWWWWWW", 30, "#ff0000")
    inside = canvas.pixels[10:30, 30:50, :3]
    assert (inside[..., 1] < 10).all()
    assert (inside[..., 0] > 200).any()
    canvas.pixels[10:30, 30:50] = 255
    assert (canvas.pixels == 255).all()


def test_letters_stand_where_they_are_anchored(canvas: Canvas) -> None:
    width = canvas.width_of("CAV1", 14, bold=True)
    for anchor in (0.0, 0.5, 1.0):
        canvas.fill("#ffffff")
        canvas.text(50, 40, "CAV1", 14, "#000000", bold=True, anchor=anchor)
        rows, columns = np.nonzero(canvas.pixels[..., 0] < 128)
        assert columns.min() == pytest.approx(50 - anchor * width, abs=2)
        assert columns.max() == pytest.approx(50 + (1 - anchor) * width, abs=2)
        assert (rows.min() + rows.max()) / 2 == pytest.approx(40, abs=1)


def test_a_halo_surrounds_the_letters(canvas: Canvas) -> None:
    canvas.fill("#000000")
    canvas.text(50, 40, "I", 20, "#0072b2", bold=True, anchor=0.5, halo="#ffffff")
    assert is_colour(canvas.pixels, 49, 40, "#0072b2")
    assert canvas.pixels[40, 40:49, 0].max() > 200


def test_letters_off_the_sheet_do_no_harm(canvas: Canvas) -> None:
    for x, y in ((-500, 40), (500, 40), (50, -90), (50, 500), (-5, 40), (95, 40), (50, 79)):
        canvas.text(x, y, "CAV1 and more", 14, "#000000")


def test_a_part_is_put_back_as_it_was(canvas: Canvas) -> None:
    canvas.polygon(SQUARE, "#d55e00")
    before = canvas.pixels.copy()
    kept = canvas.part(10, 10, 60, 60).copy()
    canvas.fill("#000000")
    canvas.part(10, 10, 60, 60)[:] = kept
    assert (canvas.pixels[10:70, 10:70] == before[10:70, 10:70]).all()
    assert (canvas.pixels[:10] != before[:10]).any()


CANVAS = Canvas(10, 10)
texts = st.text(st.characters(codec="utf-8", categories=("L", "N", "P", "Zs")), max_size=120)


@given(texts, st.floats(30, 400), st.booleans())
def test_a_shortened_text_fits(words: str, room: float, bold: bool) -> None:
    cut = shortened(CANVAS, words, 12, room, bold)
    assert CANVAS.width_of(cut, 12, bold) <= room
    assert cut == " ".join(words.split()) or cut.endswith("…")


@given(texts, st.integers(0, 4))
def test_wrapped_lines_fit_and_are_not_too_many(words: str, lines: int) -> None:
    broken = wrapped(CANVAS, words, 12, 200, lines)
    assert len(broken) <= lines
    assert all(CANVAS.width_of(line, 12) <= 200 for line in broken)


def test_nothing_is_lost_where_there_is_room() -> None:
    words = "FASTER still lets CAV1, CAV4, HDV1, HDV2 and HDV4 pass first, which all have been there before"
    assert " ".join(wrapped(CANVAS, words, 12, 200, 9)) == words
    assert wrapped(CANVAS, words, 12, 200, 2)[-1].endswith("…")


@pytest.mark.parametrize("words", ["", " ", "\n"])
def test_no_words_no_lines(words: str) -> None:
    assert wrapped(CANVAS, words, 12, 200, 3) == []
    CANVAS.text(5, 5, words, 12, "#000000")
