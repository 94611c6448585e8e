"""Whole runs over HTTP, against a server on loopback that answers from the prompt alone."""

import json
import sqlite3
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

sys.path.insert(0, str(Path(__file__).with_name("llm")))

from faults import FAULTS, Fault
from loopback import Loopback, Request

from codriving.cli.app import app

CANARY = "canary-3f7a91c2"
TABLES = ("episodes.csv", "summary.csv", "summary.md")


def call(*args: str) -> Result:
    return CliRunner().invoke(app, list(args))


def toy(server: Loopback, *more: str) -> list[str]:
    """A model that costs nothing, in short episodes."""
    return ["llm=custom", "llm.model=openai/toy", f"llm.api_base={server.url}", "llm.attempts=1", *more]


def run(server: Loopback, output: Path, *more: str) -> Result:
    settings = ["episodes=2", "seed=10000", "scenario.time_limit=3", f"output={output}", "run=mine"]
    return call("run", *toy(server, *settings, *more))


def lasting(folder: Path) -> dict[str, bytes]:
    """What has to be the same in a replay."""
    paths = [folder / name for name in TABLES]
    paths += [
        path for path in folder.glob("episodes/*/*/*") if path.name not in {"timing.json", "error.txt", "SHA256SUMS"}
    ]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


@pytest.fixture
def closed() -> Loopback:
    """A server that was there once."""
    with Loopback() as server:
        pass
    return server


def test_a_model_judges_human_drivers_before_it_decides(tmp_path: Path) -> None:
    with Loopback() as server:
        asked = ["suite=standoff", "judgement=llm", "episodes=1", "scenario.time_limit=4"]
        result = run(server, tmp_path, *asked)
    assert result.exit_code == 0, result.output
    (folder,) = (tmp_path / "run" / "mine").glob("episodes/*/*")
    lines = [json.loads(line) for line in (folder / "transcript.jsonl").read_text().splitlines()]
    judged = [line for line in lines if line["purpose"] == "judge"]
    assert judged
    assert not [line["problem"] for line in judged if line["problem"]]
    chances = [chance for line in judged for name, chance in line["value"].items() if name != "reason"]
    assert set(chances) <= {0.1, 0.9}
    decided = [json.loads(line) for line in (folder / "decisions.jsonl").read_text().splitlines()]
    said = [j for line in decided for cav in line["cavs"] for j in cav.get("judgements", {}).values()]
    assert len(said) == len(chances)
    assert all((j["answer"] == "yields") == (j["yields"] == 0.9) for j in said)
    assert all(j["reason"] == "judged by the model: That is what the situation asks for." for j in said)


@pytest.mark.parametrize("scenario", ["intersection", "roundabout", "highway", "merge"])
def test_a_model_drives_every_scenario(scenario: str, tmp_path: Path) -> None:
    with Loopback() as server:
        result = run(server, tmp_path, f"scenario={scenario}", "episodes=1")
    assert result.exit_code == 0, result.output
    folder = tmp_path / "run" / "mine"
    counts: dict[str, float] = {}
    for record in folder.glob("episodes/*/*/record.json"):
        found = json.loads(record.read_text())
        assert found["reasoner"] == "openai/toy (informed)"
        for name, number in found["counts"].items():
            counts[name] = counts.get(name, 0) + number
    # One more than the episodes count: the request before the first of them.
    assert counts["model_calls"] == len(server.requests) - 1 > 0
    assert counts["prompt_tokens"] > counts["completion_tokens"] > 0
    assert counts.get("fallbacks", 0) == 0
    assert " tokens, " in result.stderr


def test_a_replay_leaves_the_same_bytes_without_a_server(tmp_path: Path) -> None:
    cache = f"llm.cache_file={tmp_path / 'answers.sqlite'}"
    with Loopback() as server:
        assert run(server, tmp_path / "live", "llm.cache=use", cache).exit_code == 0
    replayed = run(server, tmp_path / "again", "llm.cache=replay", cache, "workers=1")
    assert replayed.exit_code == 0, replayed.output
    first, second = (lasting(tmp_path / name / "run" / "mine") for name in ("live", "again"))
    assert sorted(first) == sorted(second)
    assert any(name.endswith("transcript.jsonl") for name in first)
    for name in first:
        assert first[name] == second[name], name
    # What is not in the cache is asked for nowhere else.
    missing = run(server, tmp_path / "other", "llm.cache=replay", cache, "seed=10007")
    assert missing.exit_code == 2
    assert "answer cache" in missing.stderr


@pytest.mark.parametrize("fault", ["echo_key_401", "echo_key_400", "echo_key_500", "echo_key_answer"])
@pytest.mark.parametrize("fine", [0, 6])
def test_a_key_is_found_nowhere(
    fault: str, fine: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("CANARY_KEY", CANARY)
    cache = ("llm.cache=use", f"llm.cache_file={tmp_path / 'answers.sqlite'}")
    with Loopback(lambda request: "ok" if request.number < fine else fault) as server:
        result = run(server, tmp_path, "llm.api_key_env=CANARY_KEY", *cache)
    assert any(CANARY in request.headers["authorization"] for request in server.requests[fine:])
    if fault != "echo_key_answer":
        assert result.exit_code == (1 if fine else 2), result.output
    captured = capfd.readouterr()
    assert CANARY not in result.output + captured.out + captured.err
    for path in tmp_path.rglob("*"):
        assert not path.is_file() or CANARY.encode() not in path.read_bytes(), path


def test_finish_reasons_and_special_tokens_are_kept(tmp_path: Path) -> None:
    details = {"prompt_tokens_details": {"cached_tokens": 7}, "completion_tokens_details": {"reasoning_tokens": 3}}

    def wrap(body: dict[str, Any]) -> dict[str, Any]:
        choice = {**body["choices"][0], "finish_reason": "length"}
        return {**body, "model": "qwen.gguf", "choices": [choice], "usage": {**body["usage"], **details}}

    with Loopback(lambda request: replace(FAULTS["ok"], wrap=wrap)) as server:
        result = run(server, tmp_path, "episodes=1", "llm.label=ours")
    assert result.exit_code == 0, result.output
    folder = tmp_path / "run" / "mine"
    [path] = folder.glob("episodes/*/*/record.json")
    record = json.loads(path.read_text())
    calls = [
        c for line in path.with_name("transcript.jsonl").read_text().splitlines() for c in json.loads(line)["calls"]
    ]
    number = len(calls)
    assert record["reasoner"] == "ours (informed)"
    assert [record["counts"][name] for name in ("cut_off", "cached_tokens", "reasoning_tokens")] == [
        number,
        7 * number,
        3 * number,
    ]
    assert {(call["finish_reason"], call["model"]) for call in calls} == {("length", "qwen.gguf")}
    assert json.loads((folder / "manifest.json").read_text())["versions"]["model ours"] == "qwen.gguf"
    assert "decisions_by_model" in (folder / "summary.csv").read_text()


def test_check_asks_for_one_order_and_one_decision() -> None:
    with Loopback() as server:
        result = call("check", *toy(server))
    assert result.exit_code == 0, result.output
    assert "Negotiation" in result.stdout
    assert "Decision of CAV" in result.stdout
    assert result.stdout.splitlines()[-1] == "Answered in the form asked for."
    # One to see that it is there, one order, one decision.
    assert len(server.requests) == 3


def test_check_says_when_a_fallback_was_needed() -> None:
    with Loopback(lambda request: "ok" if request.number < 2 else "empty_content") as server:
        result = call("check", *toy(server))
    assert result.exit_code == 1, result.output
    assert result.stdout.splitlines()[-1] == "No usable answer for the decision: a fallback was needed."


@pytest.mark.parametrize("fault", ["missing_ids", "cyclic", "duplicate_ids"])
def test_check_wants_an_order_for_every_pair(fault: str) -> None:
    with Loopback(lambda request: fault) as server:
        result = call("check", *toy(server))
    assert result.exit_code == (0 if fault == "duplicate_ids" else 1), result.output


def test_check_does_not_say_twice_what_a_model_is_called() -> None:
    with Loopback(lambda request: "ok") as server:
        result = call("check", *toy(server), "llm.label=toy")
    assert result.stdout.startswith("toy on intersection"), result.output


def test_check_says_each_retry_and_what_the_server_calls_its_model() -> None:
    def plan(request: Request) -> Fault:
        fault = FAULTS["429"] if request.number == 1 else FAULTS["ok"]
        return replace(fault, wrap=lambda body: {**body, "model": "qwen.gguf"})

    with Loopback(plan) as server:
        result = call("check", *toy(server), "llm.attempts=2", "llm.label=ours")
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("ours, which its server calls qwen.gguf, on intersection")
    assert result.stderr.startswith("ours takes no more requests for now (429: Rate limit reached); attempt 2 of 2 in ")
    assert result.stderr.count("\n") == 1


def test_a_label_and_the_servers_name_are_in_table_manifest_and_transcript(tmp_path: Path) -> None:
    def plan(request: Request) -> Fault:
        return Fault(wrap=lambda body: {**body, "model": "qwen.gguf"})

    with Loopback(plan) as server:
        assert run(server, tmp_path, "llm.label=ours", "episodes=1").exit_code == 0
        again = run(server, tmp_path, "llm.label=ours", "episodes=2")
        assert (again.exit_code, "other versions" in again.stdout) == (0, False), again.output
        server.plan = ()
        changed = run(server, tmp_path, "llm.label=ours", "episodes=3")
    assert "model ours qwen.gguf -> toy" in changed.stdout
    folder = tmp_path / "run" / "mine"
    assert json.loads((folder / "manifest.json").read_text())["versions"]["model ours"] == "qwen.gguf"
    record, transcript = (
        next(folder.glob("episodes/*/*/record.json")),
        next(folder.glob("episodes/*/*/transcript.jsonl")),
    )
    assert json.loads(record.read_text())["reasoner"] == "ours (informed)"
    assert '"model": "qwen.gguf"' in transcript.read_text()
    assert "ours" in (folder / "summary.md").read_text()


@pytest.mark.parametrize("fault", ["empty_content", "thinking", "html"])
def test_a_model_that_never_answers_stops_the_run(fault: str, tmp_path: Path) -> None:
    thinking = replace(FAULTS["cut_off"], write=lambda content: "")

    def plan(request: Request) -> Fault:
        return FAULTS["ok"] if request.number == 0 else thinking if fault == "thinking" else FAULTS[fault]

    with Loopback(plan) as server:
        result = run(server, tmp_path, "llm.fallbacks_at_first=5", "workers=1")
    assert (result.exit_code, result.stdout) == (2, ""), result.output
    last = result.stderr.splitlines()[-1]
    assert "gave no usable answer to the first " in last
    assert "go on with: codriving run" in last
    assert result.stderr.count("raise llm.max_tokens") == (2 if fault == "thinking" else 0)


def test_a_short_run_without_any_answer_says_so(tmp_path: Path) -> None:
    with Loopback(lambda request: "ok" if request.number == 0 else "empty_content") as server:
        result = run(server, tmp_path, "episodes=1", "scenario.time_limit=1", "llm.fallbacks_at_first=100000")
    assert result.exit_code == 0, result.output
    assert "openai/toy: no usable answer to any of " in result.stderr


def test_fields_of_a_request_are_in_the_manifest_as_they_are(tmp_path: Path) -> None:
    extra = "llm.extra={stop_token: '</s>', tokenizer: cl100k_base, think: false}"
    with Loopback() as server:
        settings = (extra, "llm.max_tokens_field=max_completion_tokens", "llm.api_key_header=X-Team-Key")
        assert run(server, tmp_path, "episodes=1", "scenario.time_limit=1", *settings).exit_code == 0
        other = run(server, tmp_path, "episodes=1", "scenario.time_limit=1", *settings, "llm.extra={think: true}")
    assert all(request.body["stop_token"] == "</s>" for request in server.requests)
    folder = tmp_path / "run" / "mine"
    (cell,) = json.loads((folder / "manifest.json").read_text())["cells"]
    told = {name: json.loads(value) for name, value in cell["settings"].items() if name.startswith("llm.")}
    assert told["llm.max_tokens_field"] == "max_completion_tokens"
    assert [told[f"llm.extra.{name}"] for name in ("stop_token", "tokenizer", "think")] == [
        "</s>",
        "cl100k_base",
        False,
    ]
    assert "api_key_header: X-Team-Key" in next(folder.rglob("config.yaml")).read_text()
    assert other.exit_code == 2, "another field is another run"


def test_no_credit_in_the_middle_stops_the_run_and_a_wait_does_not(tmp_path: Path) -> None:
    refused: set[str] = set()

    def plan(request: Request) -> Fault:
        busy = Fault(status=429, error="You exceeded your current quota; see billing. Try again in 1ms.", code="busy")
        # The same question a second time is never refused, whatever number it then has.
        if request.number % 5 != 2 or request.text in refused:
            return FAULTS["ok"]
        refused.add(request.text)
        return busy

    with Loopback(plan) as server:
        result = run(server, tmp_path / "busy", "llm.attempts=2", "scenario.time_limit=1", "suite=paper")
        assert result.exit_code == 0, result.output
        assert result.stderr.count("takes no more requests for now") == len(refused) > 2
        server.plan = lambda request: FAULTS["quota"] if request.number > len(before) + 3 else FAULTS["ok"]
        before = list(server.requests)
        result = run(server, tmp_path / "quota", "llm.attempts=2", "scenario.time_limit=1")
    assert result.exit_code == 2
    assert "has no credit left for this key" in result.stderr
    assert len(result.stderr.splitlines()) == 1


def test_check_of_a_server_that_is_not_there_is_one_line(closed: Loopback) -> None:
    result = call("check", *toy(closed))
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1


def test_a_server_that_is_not_there_leaves_nothing_behind(closed: Loopback, tmp_path: Path) -> None:
    result = run(closed, tmp_path)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


LATE = ("llm.latency=measured", "suite=standoff", "scenario.time_limit=4", "episodes=1", "seed=20000")


def counts_of(folder: Path) -> dict[str, float]:
    (record,) = folder.glob("episodes/*/*/record.json")
    counts: dict[str, float] = json.loads(record.read_text())["counts"]
    return counts


def test_times_are_measured_kept_and_replayed(tmp_path: Path) -> None:
    cache = f"llm.cache_file={tmp_path / 'answers.sqlite'}"
    with Loopback() as server:
        live = run(server, tmp_path / "live", "llm.cache=use", cache, *LATE)
    assert live.exit_code == 0, live.output
    assert "Thinking takes time (llm.latency=measured)" in live.stdout
    assert "Not repeatable: llm.latency=measured" in live.stdout
    again = run(server, tmp_path / "again", "llm.cache=replay", cache, *LATE)
    assert again.exit_code == 0, again.output
    assert "Not repeatable" not in again.stdout
    folders = [tmp_path / name / "run" / "mine" for name in ("live", "again")]
    first, second = map(lasting, folders)
    assert {name for name in first if first[name] != second[name]} == {"summary.csv", "summary.md"}
    assert b"repeatable" in first["summary.csv"]
    assert b"repeatable" not in second["summary.csv"]
    marks = [json.loads((folder / "manifest.json").read_text())["cells"][0].get("repeatable") for folder in folders]
    assert marks == [False, None]
    # An answer that took milliseconds is one step late, one that took 1.2 s three steps: as the cache has it.
    with sqlite3.connect(tmp_path / "answers.sqlite") as connection:
        stored = connection.execute("SELECT key, reply FROM answers").fetchall()
        slower = [(json.dumps({**json.loads(reply), "seconds": 1.2}), key) for key, reply in stored]
        connection.executemany("UPDATE answers SET reply = ? WHERE key = ?", slower)
    connection.close()
    slow = run(server, tmp_path / "slow", "llm.cache=replay", cache, *LATE, "scenario.time_limit=1.5")
    assert slow.exit_code == 0, slow.output
    folder = tmp_path / "slow" / "run" / "mine"
    lines = [json.loads(line) for line in next(folder.glob("episodes/*/*/transcript.jsonl")).read_text().splitlines()]
    assert {line["time"] for line in lines} == {0.0}
    assert {call["seconds"] for line in lines for call in line["calls"]} == {1.2}
    assert counts_of(folder)["late_decisions"] == counts_of(folder)["late_orders"] == 0
    assert counts_of(folders[1])["late_decisions"] > 4


def test_a_run_with_measured_times_is_not_extended(tmp_path: Path) -> None:
    cache = f"llm.cache_file={tmp_path / 'answers.sqlite'}"
    short = (*LATE, "scenario.time_limit=1", "llm.cache=use", cache)
    with Loopback() as server:
        assert run(server, tmp_path, *short).exit_code == 0
        more, replayed = run(server, tmp_path, *short, "episodes=2"), run(server, tmp_path, *short, "llm.cache=replay")
        beside = run(server, tmp_path, "llm.latency=0.7,measured", *short[1:])
    (line,) = more.stderr.splitlines()
    assert (more.exit_code, more.stdout) == (2, "")
    assert line.startswith("error: intersection-codriving-full in ")
    assert (
        "with llm.latency=measured and a model that is asked, so that it cannot be repeated and is not extended" in line
    )
    # What is complete is printed again, marked as it was driven; and other rows may stand beside it.
    assert replayed.exit_code == beside.exit_code == 0, replayed.output + beside.output
    assert "Nothing to do" in replayed.stdout
    assert "Not repeatable" in replayed.stdout
    cells = json.loads((tmp_path / "run" / "mine" / "manifest.json").read_text())["cells"]
    assert [cell.get("repeatable") for cell in cells] == [False, None]


def test_a_replayed_run_is_not_extended_by_measuring(tmp_path: Path) -> None:
    cache = f"llm.cache_file={tmp_path / 'answers.sqlite'}"
    short = (*LATE, "scenario.time_limit=1", cache)
    with Loopback() as server:
        assert run(server, tmp_path / "live", *short, "llm.cache=use").exit_code == 0
        assert run(server, tmp_path, *short, "llm.cache=replay").exit_code == 0
        more = run(server, tmp_path, *short, "llm.cache=use", "episodes=2")
    assert more.exit_code == 2
    assert "is not extended" in more.stderr


@pytest.mark.parametrize("latency", ["sometimes", "-1", "61"])
def test_a_time_that_is_none_is_refused(latency: str, closed: Loopback, tmp_path: Path) -> None:
    result = run(closed, tmp_path, f"llm.latency={latency}")
    assert result.exit_code == 2
    said = f"error: llm.latency must be none, measured or a time of 0 to 60 s, got {latency}"
    assert result.stderr.splitlines()[0].startswith(said), result.stderr
