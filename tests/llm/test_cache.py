"""The cache keeps what was answered, for many at once and through every accident, and replays nothing else."""

import multiprocessing
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.errors import ModelError
from codriving.llm.cache import AnswerCache, key_of

REQUEST = {"model": "m", "messages": [{"role": "user", "content": "who goes first?"}], "temperature": 0.0}
REPLY = {"text": '{"first": "CAV0"} \u00fc \x1b \ud800', "seconds": 0.25, "cost": None, "attempts": 1}


def asked(number: int) -> dict[str, Any]:
    return {**REQUEST, "number": number}


def test_what_was_kept_is_found_by_each_process(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "llm-cache.sqlite"
    cache = AnswerCache(path, "use")
    assert cache.find(REQUEST) is None
    assert not path.exists()
    assert cache.keep(REQUEST, REPLY) == REPLY
    assert cache.find(REQUEST) == REPLY
    assert cache.find(asked(1)) is None
    assert AnswerCache(path, "use").find(REQUEST) == REPLY
    assert AnswerCache(str(path), "replay").find(REQUEST) == REPLY


def test_the_first_reply_stays_and_each_process_is_given_it(tmp_path: Path) -> None:
    one, other = AnswerCache(tmp_path / "c", "use"), AnswerCache(tmp_path / "c", "use")
    assert one.keep(REQUEST, {"text": "first"}) == {"text": "first"}
    assert other.keep(REQUEST, {"text": "second"}) == {"text": "first"}


def test_a_miss_in_replay_says_which_file_and_what_fills_it(tmp_path: Path) -> None:
    path = tmp_path / "c"
    with pytest.raises(ModelError, match=r"replay: there is no answer cache .*/c \(model m\); set llm\.cache=use"):
        AnswerCache(path, "replay").find(REQUEST)
    assert not path.exists()
    AnswerCache(path, "use").keep(REQUEST, REPLY)
    with pytest.raises(
        ModelError, match=r"/c does not hold what is asked now \(model m\); set llm\.cache=use"
    ) as caught:
        AnswerCache(path, "replay").find(asked(1))
    assert "\n" not in str(caught.value)


def test_replay_changes_nothing(tmp_path: Path) -> None:
    cache = AnswerCache(tmp_path / "c", "use")
    cache.keep(REQUEST, REPLY)
    cache.close()
    before = (tmp_path / "c").read_bytes()
    replay = AnswerCache(tmp_path / "c", "replay")
    assert replay.keep(asked(1), REPLY) == REPLY
    assert replay.find(REQUEST) == REPLY
    replay.close()
    assert (tmp_path / "c").read_bytes() == before


def test_a_closed_cache_is_one_file_that_can_be_copied_and_used_again(tmp_path: Path) -> None:
    cache = AnswerCache(tmp_path / "c", "use")
    cache.keep(REQUEST, REPLY)
    cache.close()
    cache.close()
    assert [path.name for path in tmp_path.iterdir()] == ["c"]
    shutil.copy(tmp_path / "c", tmp_path / "d")
    assert AnswerCache(tmp_path / "d", "replay").find(REQUEST) == REPLY
    assert cache.find(REQUEST) == REPLY


def test_threads_share_one_connection(tmp_path: Path) -> None:
    cache = AnswerCache(tmp_path / "c", "use")

    def work(k: int) -> dict[str, Any]:
        cache.keep(asked(k % 20), {"text": str(k)})
        found = cache.find(asked(k % 20))
        assert found is not None
        return found

    with ThreadPoolExecutor(16) as pool:
        found = list(pool.map(work, range(200)))
    for k in range(20):
        assert len({reply["text"] for reply in found[k::20]}) == 1


def keep_many(path: str) -> list[str]:
    cache = AnswerCache(path, "use")
    return [cache.keep(asked(k), {"text": f"{os.getpid()}"})["text"] for k in range(50)]


def test_processes_that_ask_the_same_get_the_same(tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(3, mp_context=context) as pool:
        first, *others = pool.map(keep_many, [str(tmp_path / "c")] * 3)
    assert all(other == first for other in others)


def test_a_program_that_ends_leaves_one_file(tmp_path: Path) -> None:
    code = f"""
from codriving.llm.cache import AnswerCache
cache = AnswerCache({str(tmp_path / "c")!r}, "use")
cache.keep({{"model": "m"}}, {{"text": "x"}})
"""
    subprocess.run([sys.executable, "-c", code], check=True)
    assert [path.name for path in tmp_path.iterdir()] == ["c"]


def killed(path: str) -> None:
    keep_many(path)
    os.kill(os.getpid(), signal.SIGKILL)


def test_what_was_kept_survives_a_kill(tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    process = context.Process(target=killed, args=(str(tmp_path / "c"),))
    process.start()
    process.join(60)
    assert process.exitcode == -signal.SIGKILL
    for mode in ("replay", "use"):
        cache = AnswerCache(tmp_path / "c", mode)
        assert [cache.find(asked(k)) for k in range(50)] == [{"text": f"{process.pid}"}] * 50
        cache.close()


@pytest.mark.parametrize("mode", ["use", "replay"])
def test_what_is_no_cache_is_refused_in_one_line_and_left_alone(tmp_path: Path, mode: str) -> None:
    path = tmp_path / "notes.txt"
    path.write_text("not a database, " * 100)
    with pytest.raises(ModelError, match=r"the answer cache .*notes\.txt cannot be used .*llm\.cache_file") as caught:
        AnswerCache(path, mode).find(REQUEST)
    assert "\n" not in str(caught.value)
    assert path.read_text() == "not a database, " * 100
    (tmp_path / "file").write_text("")
    with pytest.raises(ModelError, match="cannot be used"):
        AnswerCache(tmp_path / "file" / "c", "use").keep(REQUEST, REPLY)


@pytest.mark.parametrize("mode", ["use", "replay"])
def test_a_cache_of_another_version_or_a_damaged_reply_is_refused(tmp_path: Path, mode: str) -> None:
    cache = AnswerCache(tmp_path / "c", "use")
    cache.keep(REQUEST, REPLY)
    cache.close()
    connection = sqlite3.connect(tmp_path / "c", isolation_level=None)
    connection.execute("UPDATE answers SET reply = '{\"text\": '")
    with pytest.raises(ModelError, match="cannot be used"):
        AnswerCache(tmp_path / "c", mode).find(REQUEST)
    connection.execute("PRAGMA user_version = 99")
    connection.close()
    with pytest.raises(ModelError, match="another version wrote it"):
        AnswerCache(tmp_path / "c", mode).find(REQUEST)


values = (
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(max_size=3)
)
requests = st.dictionaries(st.text(max_size=2), values | st.lists(values, max_size=2), max_size=3)


@given(requests, requests)
def test_requests_have_the_same_key_just_if_they_are_the_same(one: dict[str, Any], other: dict[str, Any]) -> None:
    turned = dict(reversed(one.items()))
    assert key_of(one) == key_of(turned)
    if key_of(one) == key_of(other):
        assert one == other


def test_everything_asked_is_part_of_the_key() -> None:
    changes = [{"model": "n"}, {"messages": []}, {"temperature": 1.0}, {"form": "text"}, {"api_base": "http://a"}]
    assert len({key_of(REQUEST), *(key_of({**REQUEST, **change}) for change in changes)}) == 6
