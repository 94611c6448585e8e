"""What would fail in every episode is refused before the first: a file that cannot be used, an embedder that fails."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from loopback import Loopback
from remembered import description, experience, filled, frozen, interaction, online

from codriving.errors import MemoryFileError, ModelError, UserError
from codriving.llm import sqlite_file
from codriving.memory import store_file
from codriving.memory.reading import read_memory

KEY = "TEST_EMBEDDING_KEY"


@pytest.fixture
def server() -> Iterator[Loopback]:
    with Loopback() as running:
        yield running


def edit(path: Path, *statements: str) -> Path:
    with closing(sqlite3.connect(path)) as connection:
        for statement in statements:
            connection.execute(statement)
        connection.commit()
    return path


RENAMED = (
    "CREATE TABLE other AS SELECT id, vector, action AS deed, verdict, lesson FROM experiences",
    "DROP TABLE experiences",
    "ALTER TABLE other RENAME TO experiences",
)


@pytest.mark.parametrize(
    ("statements", "said"),
    [
        (RENAMED, "the table experiences has the columns id, vector, deed"),
        (("DROP TABLE interactions",), "the table interactions is missing"),
        (("ALTER TABLE sightings ADD COLUMN more",), "the table sightings has the columns .*, more"),
        (("DROP TABLE about",), "the table about is missing"),
        (("UPDATE interactions SET seed = 'first'",), "1 interactions cannot be read"),
        (("UPDATE interactions SET scenario = X'00'",), "1 interactions cannot be read"),
        (("UPDATE sightings SET step = 'early'",), "1 sightings cannot be read"),
        (("UPDATE sightings SET experience = 99",), "1 sightings cannot be read"),
        (("UPDATE experiences SET vector = 'text'",), "1 experiences cannot be read"),
        (("UPDATE experiences SET lesson = 5.5", "UPDATE experiences SET lesson = X'00'"), "1 experiences cannot be"),
        (("UPDATE experiences SET numbers = '[1]'",), "1 experiences cannot be read"),
        (("UPDATE experiences SET numbers = '{}'",), "1 experiences cannot be read"),
        (("UPDATE experiences SET numbers = json_set(numbers, '$.speed', 'fast')",), "1 experiences cannot be read"),
        (("UPDATE experiences SET numbers = json_remove(numbers, '$.its_ttcp')",), "1 experiences cannot be read"),
        (("UPDATE experiences SET kinds = json_set(kinds, '$.order', 'third')",), "1 experiences cannot be read"),
        (("UPDATE experiences SET kinds = '{}'",), "1 experiences cannot be read"),
        (("UPDATE experiences SET effect = '{\"other\": 1}'",), "1 experiences cannot be read"),
        (("UPDATE experiences SET action = 'FLY'",), "1 experiences cannot be read"),
        (("UPDATE experiences SET scene = CAST(X'FFFE' AS TEXT)",), "UTF-8"),
        ((f"UPDATE experiences SET vector = X'{'00004040' * 104}'",), "does not have the length 1"),
        ((f"UPDATE experiences SET vector = X'{'0000C07F' * 104}'",), "not finite"),
        (("UPDATE about SET value = '1e9' WHERE key = 'dimension'",), "holds vectors of 1e9 numbers|1e9"),
    ],
)
def test_a_file_whose_contents_do_not_fit_is_refused_by_all_who_open_it(
    statements: tuple[str, ...], said: str, tmp_path: Path
) -> None:
    path = edit(filled(tmp_path / "m.sqlite", [experience()]), *statements)
    for opening in (lambda: frozen(path), lambda: online(path).prepare(), lambda: read_memory(path)):
        with pytest.raises(MemoryFileError, match=said) as caught:
            opening()
        assert str(path) in str(caught.value)


@pytest.mark.parametrize("content", [b"", b"SQLite format 3\x00" + b"\xff" * 5000, b"text " * 500])
def test_what_is_no_database_is_refused_in_one_line(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    path.write_bytes(content)
    for opening in (lambda: frozen(path), lambda: online(path).prepare(), lambda: read_memory(path)):
        with pytest.raises(MemoryFileError, match=r"m\.sqlite (cannot be read as|is no) .*name another one"):
            opening()


def test_a_memory_that_is_whole_is_left_as_it_is(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience(), experience(description(relation="none"), step=9)])
    before = path.read_bytes()
    online(path).prepare()
    frozen(path).prepare()
    assert path.read_bytes() == before


def test_a_file_that_is_not_there_is_made_with_its_folder(tmp_path: Path) -> None:
    path = tmp_path / "new" / "folder" / "m.sqlite"
    online(path).prepare()
    assert len(read_memory(path).snapshot) == 0
    learner = online(path)
    learner.begin(interaction())
    learner.learn([experience()])
    assert len(read_memory(path).snapshot) == 1


def test_a_read_only_file_is_refused_before_the_first_episode(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = filled(tmp_path / "m.sqlite", [experience()])
    # As SQLite opens a file that may not be written; root may write any.
    connect = store_file.connect_sqlite
    monkeypatch.setattr(store_file, "connect_sqlite", lambda uri: connect(uri.replace("mode=rw", "mode=ro")))
    with pytest.raises(MemoryFileError, match=r"cannot write the memory .* readonly database; permit writing it"):
        online(path).prepare()
    frozen(path).prepare()


def test_a_folder_that_cannot_be_is_refused_before_the_first_episode(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(MemoryFileError, match=r"cannot write the memory .*; permit writing it and its folder"):
        online(tmp_path / "file" / "m.sqlite").prepare()


def test_a_locked_file_is_said_to_be_locked_and_not_damaged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = filled(tmp_path / "m.sqlite", [experience()])
    monkeypatch.setattr(sqlite_file, "BUSY", 0.0)
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("BEGIN EXCLUSIVE")
        for opening in (lambda: frozen(path), lambda: online(path).prepare(), lambda: read_memory(path)):
            with pytest.raises(MemoryFileError, match=r"is locked by another program that writes it; wait until"):
                opening()


def litellm(server: Loopback, **change: object) -> dict[str, object]:
    settings = {"embedder": "litellm", "embedding_model": "some-embedder", "embedding_api_base": server.url}
    return {**settings, "embedding_key_env": None, "embedding_deadline": 5.0, **change}


def test_a_missing_key_is_said_before_the_first_episode_and_the_same_run_goes_on_with_it(
    server: Loopback, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(KEY, raising=False)
    with pytest.raises(ModelError, match=f"{KEY} is not set; put the key of the embedding model into"):
        online(None, **litellm(server, embedding_key_env=KEY)).prepare()
    monkeypatch.setenv(KEY, "some-key")
    online(None, **litellm(server, embedding_key_env=KEY)).prepare()
    assert server.embedded == [["A vehicle waits."]]


def test_a_server_that_is_not_there_or_does_not_know_the_model_is_one_line(server: Loopback) -> None:
    with Loopback() as gone:
        address = gone.url
    with pytest.raises(ModelError, match=r"some-embedder cannot be used: .* check memory\.embedding_model") as caught:
        online(None, **litellm(server, embedding_api_base=address)).prepare()
    assert isinstance(caught.value, UserError)
    server.embedding_plan = [404]
    with pytest.raises(ModelError, match=r"some-embedder cannot be used"):
        online(None, **litellm(server)).prepare()


def test_vectors_of_another_length_are_refused_before_the_first_episode(server: Loopback, tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    learner = online(path, **litellm(server))
    learner.prepare()
    learner.begin(interaction())
    learner.learn([experience()])
    frozen(path, **litellm(server)).prepare()
    edit(
        path,
        "UPDATE about SET value = '3' WHERE key = 'dimension'",
        f"UPDATE experiences SET vector = X'{np.array([1, 0, 0], '<f4').tobytes().hex()}'",
    )
    with pytest.raises(MemoryFileError, match=r"holds vectors of 3 numbers, and litellm some-embedder makes 26; name"):
        frozen(path, **litellm(server)).prepare()
    with pytest.raises(MemoryFileError, match=r"holds vectors of 3 numbers, and litellm some-embedder makes 26"):
        online(path, **litellm(server)).prepare()
