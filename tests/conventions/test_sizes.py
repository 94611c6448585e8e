"""Files hold one idea each, and docstrings say what name and type do not."""

from source import files, rooms

LONGEST_FILE = 400
DOCSTRINGS = 0.2
"""Share of a room's lines that may be docstrings."""

LONGEST_ROOM = 5_000
"""Lines of a room: what one person can read in a day."""


def test_no_file_is_too_long() -> None:
    long = {str(file): file.lines for file in files() if file.lines > LONGEST_FILE}
    assert not long, "split these into two ideas"


def test_docstrings_are_a_fifth_at_most() -> None:
    shares = {}
    for room in rooms():
        inside = [file for file in files() if file.room == room]
        shares[room] = sum(len(file.docstrings) for file in inside) / sum(file.lines for file in inside)
    assert {room for room, share in shares.items() if share > DOCSTRINGS} == set()


def test_no_room_is_too_long() -> None:
    lines = {room: sum(file.lines for file in files() if file.room == room) for room in rooms()}
    assert {room: count for room, count in lines.items() if count > LONGEST_ROOM} == {}, "cut the room in two"
