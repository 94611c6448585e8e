"""A test stands where what it tests stands: ``tests/ROOM/test_FILE.py`` or ``test_FILE_topic.py``."""

from source import PACKAGE, REPOSITORY, rooms

TESTS = REPOSITORY / "tests"

OTHERS = {
    "config/test_nothing_from_data.py": "composing and building together",
    "gym/test_page.py": "a page of docs",
    "llm/test_http.py": "a whole client against a server on loopback",
    "llm/test_loopback.py": "that server itself",
    "methods/dilu/test_page.py": "a page of docs",
    "methods/single_vehicle/test_page.py": "a page of docs",
}
"""Tests of no single file, and what they are of."""


def test_every_test_is_called_after_a_file() -> None:
    strange = []
    for room in rooms():
        for test in sorted((TESTS / room).rglob("test_*.py")):
            place = test.relative_to(TESTS)
            folder = PACKAGE / place.parent
            named = {path.stem for path in folder.iterdir()} | {folder.name} if folder.is_dir() else set()
            topic = f"{test.stem.removeprefix('test_')}_"
            if not any(topic.startswith(f"{name}_") for name in named) and place.as_posix() not in OTHERS:
                strange.append(place.as_posix())
    assert not strange, "call a test after the file of the program that it is of, test_FILE.py or test_FILE_topic.py"


def test_exceptions_are_there() -> None:
    assert not [place for place in OTHERS if not (TESTS / place).is_file()]
