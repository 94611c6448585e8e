"""Files hold one idea each, and docstrings say what name and type do not."""

from source import files, rooms

LONGEST_FILE = 400
DOCSTRINGS = 0.2
"""Share of a room's lines that may be docstrings."""

LINES, CODE = 31_000, 19_500
"""Lines of the program, and those that are no docstring, comment or blank."""


def test_no_file_is_too_long() -> None:
    long = {str(file): file.lines for file in files() if file.lines > LONGEST_FILE}
    assert not long, "split these into two ideas"


def test_docstrings_are_a_fifth_at_most() -> None:
    shares = {}
    for room in rooms():
        inside = [file for file in files() if file.room == room]
        shares[room] = sum(len(file.docstrings) for file in inside) / sum(file.lines for file in inside)
    assert {room for room, share in shares.items() if share > DOCSTRINGS} == set()


def test_the_program_stays_small() -> None:
    assert sum(file.lines for file in files()) <= LINES
    assert sum(file.code for file in files()) <= CODE
