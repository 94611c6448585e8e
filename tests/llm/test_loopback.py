"""The stand-in for a model has to be right itself: what it reads, what it answers, what it does wrong."""

import json
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path
from typing import Any

import httpx
import pytest
from faults import FAULTS, too_many
from loopback import Loopback, Request

DECIDE = """# The situation
- FASTER: gets 60 m
- IDLE, SLOWER: gets 45 m; arrivals 3.2 s
- LANE_LEFT removed: CAV1 is there
Allowed actions: IDLE, FASTER
Answer as JSON."""

NEGOTIATE = """Pairs to order:
- P1: CAV0 and CAV1 cross; CAV0 arrives in 3.2 s, CAV1 in 2.1 s
- P2: CAV1 and CAV2 merge; suggested: CAV1
- P3: CAV0 and CAV2 cross
Each by its id."""

ACTION_SCHEMA = {
    "type": "object",
    "properties": {"reason": {"type": "string"}, "action": {"enum": ["IDLE", "FASTER"], "type": "string"}},
}


def body(text: str = DECIDE, form: str = "text", schema: dict[str, Any] | None = None) -> dict[str, Any]:
    asked: dict[str, Any] = {"model": "m", "messages": [{"role": "system", "content": "s"}]}
    asked["messages"].append({"role": "user", "content": text})
    if form == "json_schema":
        asked["response_format"] = {"type": form, "json_schema": {"name": "a", "schema": schema or ACTION_SCHEMA}}
    elif form != "text":
        asked["response_format"] = {"type": form}
    return asked


def post(server: Loopback, timeout: float = 5.0, headers: dict[str, str] | None = None, **asked: Any) -> httpx.Response:
    with httpx.Client(timeout=timeout, trust_env=False, verify=False) as client:
        return client.post(f"{server.url}/chat/completions", json=body(**asked), headers=headers)


def said(response: httpx.Response) -> str:
    return str(response.json()["choices"][0]["message"]["content"])


@pytest.mark.parametrize("form", ["text", "json_object", "json_schema"])
def test_decides_from_the_prompt_alone(loopback: Loopback, form: str) -> None:
    assert json.loads(said(post(loopback, form=form)))["action"] == "FASTER"
    assert json.loads(said(post(loopback, text="Allowed actions: SLOWER, IDLE")))["action"] == "SLOWER"
    slow = DECIDE.replace("60 m", "30 m")
    assert json.loads(said(post(loopback, text=slow)))["action"] == "IDLE"


def test_orders_every_pair_by_suggestion_or_arrival(loopback: Loopback) -> None:
    orders = json.loads(said(post(loopback, text=NEGOTIATE)))["orders"]
    assert [(order["pair"], order["first"]) for order in orders] == [("P1", "CAV1"), ("P2", "CAV1"), ("P3", "CAV0")]


def test_reads_who_can_be_there_first_and_what_was_agreed(loopback: Loopback) -> None:
    told = """- CAV0: 8.0 m/s, zone in 30 m, earliest 4.0 s
- CAV1: 8.0 m/s, zone in 20 m, earliest 2.5 s, behind CAV2
3. Negotiation. The order is advice.
Pairs to order:
- p1: CAV0 and CAV1 (crossing, 30 m and 20 m, TTCP 4.0 s and 2.5 s, dTTCP 1.5 s: serious danger)
- p2: CAV0 and CAV1 (crossing, 30 m and 20 m, TTCP 4.0 s and 2.5 s, dTTCP 1.5 s: serious danger; agreed: CAV0)
"""
    orders = json.loads(said(post(loopback, text=told)))["orders"]
    assert [order["first"] for order in orders] == ["CAV1", "CAV0"]


def test_fills_whatever_form_is_asked_for(loopback: Loopback) -> None:
    pair = {"type": "object", "properties": {"id": {"type": "string"}, "first": {"enum": ["CAV0", "CAV1"]}}}
    nested = {"properties": {"order": {"type": "array", "items": {"$ref": "#/$defs/Pair"}}}, "$defs": {"Pair": pair}}
    answer = json.loads(said(post(loopback, text=NEGOTIATE, form="json_schema", schema=nested)))
    assert answer["order"][0] == {"id": "P1", "first": "CAV1"}
    flat = {"properties": {"P1": {"enum": ["CAV0", "CAV1"]}, "P2": {"type": "string"}}}
    told = f"{NEGOTIATE}\nThe form: {json.dumps(flat)}"
    assert json.loads(said(post(loopback, text=told, form="json_object"))) == {"P1": "CAV1", "P2": "CAV1"}


def test_a_question_asked_again_is_still_understood(loopback: Loopback) -> None:
    asked = body()
    asked["messages"] += [{"role": "assistant", "content": "{}"}, {"role": "user", "content": "That is no answer."}]
    answer = httpx.post(f"{loopback.url}/chat/completions", json=asked, trust_env=False, verify=False)
    assert json.loads(said(answer))["action"] == "FASTER"


def test_counts_tokens_from_the_text_and_records_requests(loopback: Loopback) -> None:
    answer = post(loopback)
    assert answer.json()["usage"]["prompt_tokens"] == -(-(len(DECIDE) + 1) // 4)
    assert answer.json()["usage"]["completion_tokens"] == -(-len(said(answer)) // 4)
    assert [request.messages[1]["content"] for request in loopback.requests] == [DECIDE]
    assert loopback.requests[0].length == len(DECIDE) + 1


def test_keeps_count_of_what_happens_at_once() -> None:
    with (
        Loopback(latency=0.05) as server,
        httpx.Client(trust_env=False, verify=False) as client,
        ThreadPoolExecutor(8) as pool,
    ):
        list(pool.map(lambda k: client.post(f"{server.url}/chat/completions", json=body()), range(8)))
    # Only once it is closed: a client that has its answer may be quicker than the server's own accounts.
    assert 2 <= server.high_water <= 8
    assert server.in_flight == 0
    assert server.connections <= 8


def test_one_connection_serves_many_requests(loopback: Loopback) -> None:
    with httpx.Client(trust_env=False, verify=False) as client:
        for _ in range(5):
            client.post(f"{loopback.url}/chat/completions", json=body())
    assert (len(loopback.requests), loopback.connections) == (5, 1)


@pytest.mark.parametrize(
    ("name", "status"),
    [("500", 500), ("502", 502), ("503", 503), ("429", 429), ("401", 401), ("403", 403), ("404", 404), ("400", 400)],
)
def test_statuses(serve: Callable[..., Loopback], name: str, status: int) -> None:
    server = serve([name])
    assert post(server).status_code == status
    assert post(server).status_code == 200


def test_says_how_long_to_wait(serve: Callable[..., Loopback]) -> None:
    assert post(serve([too_many("7")])).headers["Retry-After"] == "7"


def test_hangs_drips_and_drops(serve: Callable[..., Loopback]) -> None:
    server = serve(["timeout", "trickle", "drop", "drop_within"])
    with pytest.raises(httpx.ReadTimeout):
        post(server, timeout=0.05)
    with httpx.Client(timeout=0.2, trust_env=False, verify=False) as client:
        asked = client.build_request("POST", f"{server.url}/chat/completions", json=body())
        answer = client.send(asked, stream=True)
        drops = answer.iter_raw()
        assert [len(next(drops)) for _ in range(5)] == [1] * 5  # each in time, and the whole never
        answer.close()
    for _ in range(2):
        with pytest.raises(httpx.RemoteProtocolError):
            post(server)


def test_what_the_server_cannot_do(serve: Callable[..., Loopback]) -> None:
    server = serve(forms=["text"], context=500, models=["m"], key="k")
    sent = {"Authorization": "Bearer k"}
    assert post(server).status_code == 401
    assert "json_schema" in post(server, headers=sent, form="json_schema").json()["error"]["message"]
    assert post(server, headers=sent, text="x" * 600).json()["error"]["code"] == "context_length_exceeded"
    assert post(server, headers=sent).status_code == 200
    server.models = ["another"]
    assert post(server, headers=sent).status_code == 404


@pytest.mark.parametrize("name", [name for name in FAULTS if name.startswith("echo_key")])
def test_echoes_the_key(serve: Callable[..., Loopback], name: str) -> None:
    assert "Bearer canary" in post(serve([name]), headers={"Authorization": "Bearer canary"}).text


BAD: dict[str, Callable[[httpx.Response], bool]] = {
    "empty_choices": lambda r: r.json()["choices"] == [],
    "none_content": lambda r: r.json()["choices"][0]["message"]["content"] is None,
    "empty_content": lambda r: said(r) == "",
    "cut_off": lambda r: r.json()["choices"][0]["finish_reason"] == "length" and not _is_json(said(r)),
    "refusal": lambda r: "cannot" in r.json()["choices"][0]["message"]["refusal"],
    "filtered": lambda r: r.json()["choices"][0]["finish_reason"] == "content_filter",
    "html": lambda r: r.status_code == 200 and r.text.startswith("<html>"),
    "invalid_json": lambda r: not _is_json(said(r)),
    "not_an_object": lambda r: isinstance(json.loads(said(r)), list),
    "think": lambda r: "<think>" in said(r) and said(r).endswith("}"),
    "fence": lambda r: said(r).startswith("```json"),
    "prose": lambda r: not said(r).endswith("}"),
    "unknown_action": lambda r: json.loads(said(r))["action"] == "FLY",
    "removed_action": lambda r: json.loads(said(r))["action"] == "SLOWER",
    "very_long": lambda r: len(said(r)) > 1_000_000,
    "very_long_prose": lambda r: len(said(r)) > 1_000_000 and not _is_json(said(r)),
    "control_characters": lambda r: "\x1b[31m" in json.loads(said(r))["reason"],
    "raw_control_characters": lambda r: "\x07" in said(r),
}


def _is_json(text: str) -> bool:
    try:
        json.loads(text)
    except ValueError:
        return False
    return True


@pytest.mark.parametrize("name", BAD)
def test_bad_answers(serve: Callable[..., Loopback], name: str) -> None:
    assert BAD[name](post(serve([name])))


def test_bad_orders(serve: Callable[..., Loopback]) -> None:
    def orders(name: str) -> list[tuple[str, str]]:
        asked = json.loads(said(post(serve([name]), text=NEGOTIATE)))["orders"]
        return [(order["pair"], order["first"]) for order in asked]

    assert orders("unknown_ids") == [("P999", "CAV999"), ("P2", "CAV1"), ("P3", "CAV0")]
    assert orders("duplicate_ids") == [("P1", "CAV1"), ("P2", "CAV1"), ("P3", "CAV0"), ("P1", "CAV0")]
    assert orders("missing_ids") == [("P1", "CAV1"), ("P2", "CAV1")]
    pairs = {"P1": {"CAV0", "CAV1"}, "P2": {"CAV1", "CAV2"}, "P3": {"CAV0", "CAV2"}}
    before = {first: next(iter(pairs[pair] - {first})) for pair, first in orders("cyclic")}
    circle = ["CAV0", before["CAV0"], before[before["CAV0"]], "CAV0"]
    assert len(before) == 3
    assert all(before[one] == other for one, other in pairwise(circle))


def test_a_plan_may_depend_on_the_request(serve: Callable[..., Loopback]) -> None:
    def plan(request: Request) -> str | None:
        return "500" if "Pairs" in request.text else None

    server = serve(plan)
    assert (post(server).status_code, post(server, text=NEGOTIATE).status_code) == (200, 500)


def test_runs_by_hand() -> None:
    script = Path(__file__).with_name("loopback.py")
    started = [sys.executable, str(script), "--port", "0", "--always", "503"]
    with subprocess.Popen(started, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            port = int(process.stdout.readline())
            answer = httpx.post(
                f"http://127.0.0.1:{port}/v1/chat/completions", json=body(), trust_env=False, verify=False
            )
            assert answer.status_code == 503
        finally:
            process.kill()
