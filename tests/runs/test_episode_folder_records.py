"""Records survive writing and reading, and damage is named."""

import dataclasses
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from codriving.datatypes.record import (
    Collision,
    Ending,
    EpisodeRecord,
    FlowArrival,
    FlowLog,
    NamedNumber,
    Outcome,
    Participant,
    Pet,
    Score,
    TravelScore,
)
from codriving.datatypes.world import Kind
from codriving.errors import RunFolderError
from codriving.runs.episode_folder import RECORD, read_record
from codriving.runs.json_files import decode, encode

NUMBER = st.floats(allow_nan=False, allow_infinity=False)
BETTER = st.sampled_from(["higher", "lower", None])
WORD = st.text(st.characters(exclude_categories=["Cs"]), max_size=8)
COLLISION = st.builds(Collision, NUMBER, WORD, WORD, WORD)
ARRIVAL = st.builds(FlowArrival, WORD, st.sampled_from(Kind), NUMBER)
RECORDS = st.builds(
    EpisodeRecord,
    *[WORD] * 4,
    seed=st.integers(0, 2**31),
    outcome=st.builds(
        Outcome,
        st.sampled_from(Ending),
        NUMBER,
        st.dictionaries(WORD, NUMBER, max_size=2),
        st.none() | COLLISION,
        st.lists(COLLISION, max_size=2).map(tuple),
        st.lists(WORD, max_size=2).map(tuple),
        WORD,
        st.none() | st.builds(FlowLog, NUMBER, NUMBER, st.lists(ARRIVAL, max_size=2).map(tuple), st.just(())),
    ),
    scores=st.dictionaries(
        WORD,
        st.builds(
            Score,
            st.sampled_from([True, False, None]),
            st.lists(st.builds(Pet, WORD, WORD, WORD, NUMBER), max_size=2).map(tuple),
            st.lists(st.builds(TravelScore, WORD, NUMBER, NUMBER, st.none() | NUMBER), max_size=2).map(tuple),
            st.lists(st.builds(NamedNumber, WORD, st.none() | NUMBER, WORD, BETTER), max_size=2).map(tuple),
            st.dictionaries(WORD, WORD, max_size=2),
        ),
        max_size=2,
    ),
    participants=st.lists(st.builds(Participant, WORD, WORD, WORD, st.none() | NUMBER), max_size=2).map(tuple),
    decisions=st.integers(0, 1000),
    counts=st.dictionaries(WORD, st.integers(), max_size=2),
    memory=WORD,
)


@settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow])
@given(RECORDS)
def test_what_is_read_is_what_was_written(record: EpisodeRecord) -> None:
    text = encode(record)
    assert decode(EpisodeRecord, text) == record
    assert encode(record) == text


def test_a_record_of_release_01_has_one_score_without_the_name_of_its_metric(
    record: EpisodeRecord, tmp_path: Path
) -> None:
    fields = json.loads(encode(record))
    score = fields.pop("scores")["standard"]
    old = {name: score[name] for name in ("success", "pets", "travels")}
    (tmp_path / "record.json").write_text(json.dumps({**fields, "score": old}, indent=2))
    assert read_record(tmp_path) == dataclasses.replace(record, scores={"": record.scores["standard"]})
    (tmp_path / "record.json").write_text(json.dumps({**fields, "score": None}, indent=2))
    assert read_record(tmp_path) == dataclasses.replace(record, scores={})


def test_a_record_from_before_there_was_a_memory_can_be_read(record: EpisodeRecord) -> None:
    older = {name: value for name, value in json.loads(encode(record)).items() if name != "memory"}
    assert decode(EpisodeRecord, json.dumps(older)) == dataclasses.replace(record, memory="")
    with pytest.raises(ValueError, match="seed: Field required"):
        decode(EpisodeRecord, json.dumps({name: value for name, value in older.items() if name != "seed"}))


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_value_that_is_not_finite_is_never_written(record: EpisodeRecord, value: float) -> None:
    with pytest.raises(ValueError, match="JSON compliant"):
        encode(dataclasses.replace(record, outcome=dataclasses.replace(record.outcome, time=value)))


def test_a_value_of_another_type_is_never_written(record: EpisodeRecord) -> None:
    with pytest.raises(ValueError, match=r"seed: Input should be a valid integer.*, got 1\.5"):
        encode(dataclasses.replace(record, seed=1.5))
    with pytest.raises(ValueError, match=r"counts\.fallbacks.*: Input should be a valid (integer|number), got True"):
        encode(dataclasses.replace(record, counts={"fallbacks": True}))


def test_counters_are_whole_and_amounts_are_not(record: EpisodeRecord, tmp_path: Path) -> None:
    counts = {"cost_usd": 0.0, "fallbacks": 2, "prompt_tokens": 12_345_678}
    (tmp_path / "record.json").write_text(encode(dataclasses.replace(record, counts=counts)))
    read = read_record(tmp_path).counts
    assert read == counts
    assert [type(number) for number in read.values()] == [float, int, int]
    with pytest.raises(ValueError, match="JSON compliant"):
        encode(dataclasses.replace(record, counts={"cost_usd": math.inf}))


def change(path: list[str], value: object) -> Callable[[Any], str]:
    """An edit of the record's JSON: the value at a path, or its removal."""

    def edit(plain: Any) -> str:
        node = plain
        for key in path[:-1]:
            node = node[key]
        if value is None:
            del node[path[-1]]
        else:
            node[path[-1]] = value
        return json.dumps(plain)

    return edit


DAMAGE = {
    "cut in half": (lambda plain: json.dumps(plain)[:100], "EOF while parsing|expected"),
    "empty": (lambda plain: "", "Field required"),
    "a list": (lambda plain: "[]", "Input should be an object"),
    "missing field": (change(["outcome", "arrivals"], None), r"outcome\.arrivals: Field required"),
    "unknown field": (change(["colour"], "red"), "colour: Unexpected keyword argument"),
    "wrong type": (change(["seed"], "7"), "seed: Input should be a valid integer, got '7'"),
    "a switch for a number": (change(["decisions"], True), "decisions: Input should be a valid integer, got True"),
    "unknown ending": (change(["outcome", "ending"], "won"), "Input should be 'success', 'collision', .* got 'won'"),
    "NaN": (change(["outcome", "time"], math.nan), r"outcome\.time: Input should be a finite number, got nan"),
    "too large": (
        lambda plain: json.dumps(plain).replace("1.25", "1e999"),
        r"scores\.standard\.pets\.0\.value: Input should be a finite number, got inf",
    ),
}


@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_named_with_its_cure_and_nothing_is_lost(tmp_path: Path, record: EpisodeRecord, name: str) -> None:
    edit, reason = DAMAGE[name]
    path = tmp_path / RECORD
    path.write_text(edit(json.loads(encode(record))))
    before = path.read_bytes()
    with pytest.raises(RunFolderError, match=reason) as caught:
        read_record(tmp_path)
    assert str(path) in str(caught.value)
    assert "run again with the same run=<name>: only this episode is repeated" in str(caught.value)
    assert "\n" not in str(caught.value)
    assert path.read_bytes() == before


def test_a_folder_without_its_record_is_damaged(tmp_path: Path) -> None:
    with pytest.raises(RunFolderError, match="it is missing"):
        read_record(tmp_path)


def test_bytes_that_are_no_text_are_damage(tmp_path: Path) -> None:
    (tmp_path / RECORD).write_bytes(b"\xff\xfe")
    with pytest.raises(RunFolderError, match="damaged"):
        read_record(tmp_path)


def test_the_record_of_an_episode_does_not_name_a_flow(record: EpisodeRecord) -> None:
    """So records of episodes are, byte for byte, what they were before there were flows."""
    assert '"flow"' not in encode(record)
    log = FlowLog(30.0, 0.1, (FlowArrival("CAV1a", Kind.CAV, 2.5),), ())
    flow = dataclasses.replace(record, outcome=Outcome(Ending.COUNTED, 60.0, {}, flow=log))
    assert json.loads(encode(flow))["outcome"]["flow"]["wanted"] == [{"id": "CAV1a", "kind": "CAV", "time": 2.5}]
    assert decode(EpisodeRecord, encode(flow)) == flow
