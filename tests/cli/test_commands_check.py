"""`codriving check`, and keys that were typed where the name of their variable belongs."""

from typing import Any

import pytest
from typer.testing import CliRunner, Result

from codriving.cli.app import app
from codriving.cli.completion import TypedLine, complete_override
from codriving.commands.check import report
from codriving.errors import ModelError

KEY = "sk-9d8f7a6s5d4f"


def call(*args: str) -> Result:
    return CliRunner().invoke(app, list(args))


def asked(purpose: str, **changes: Any) -> dict[str, Any]:
    """A line of a transcript with one call."""
    made = {
        "text": '{"action": "IDLE"}', "form": "json_object", "prompt_tokens": 400, "completion_tokens": 30,
        "cost": 0.0001, "seconds": 0.5, "attempts": 1, "problem": "",
    }  # fmt: skip
    line = {"purpose": purpose, "subject": "", "value": {"action": "IDLE"}, "problem": "", "shortened": 0}
    return {**line, "calls": [made], **changes}


def test_help_shows_an_example() -> None:
    result = call("check", "--help")
    assert result.exit_code == 0
    assert "Example: codriving check llm=" in result.stdout


def test_the_rules_are_no_model() -> None:
    result = call("check")
    assert result.exit_code == 0
    assert result.stdout.startswith("No model is asked: ")
    assert "openai" in result.stdout


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (("method=fcfs",), "this method asks no language model"),
        (("llm=nobody",), "unknown llm 'nobody'; choices: offline, "),
        (("llm=openai,ollama",), "llm=openai,ollama: llm takes one value here"),
        (("llm=openai", "llm.max_cost=0"), "llm.max_cost must be above 0"),
    ],
)
def test_a_mistake_is_one_line(args: tuple[str, ...], said: str) -> None:
    result = call("check", *args)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"error: {said}")
    assert result.stderr.count("\n") == 1


def test_without_a_key_nothing_is_asked_and_the_line_says_what_to_set(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    result = call("check", "llm=openai")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("error: OPENAI_API_KEY is not set; ")
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("command", "token"),
    [
        ("run", f"llm.api_key_env={KEY}"),
        ("run", f"+llm.api_key_env={KEY}"),
        ("run", f"llm.api_key_env={KEY},{KEY}2"),
        ("run", f"llm.api_key_env=OPENAI_API_KEY,{KEY}"),
        ("run", f"llm.api_key_env={KEY}:["),
        ("run", f"llm.api_key={KEY}"),
        ("run", f"llm.api_base=http://me:{KEY}@127.0.0.1/v1"),
        ("check", f"llm.api_key_env={KEY}"),
        ("check", f"llm.api_key_env={KEY},{KEY}2"),
        ("ablate", f"llm.api_key_env={KEY}"),
        ("run", f"llm.headers={{'Authorization': '{KEY}'}}"),
        ("run", f"llm.headers={{X-Team: 'Bearer {KEY}'}}"),
        ("run", f"llm.extra.api_key={KEY}"),
        ("check", f"llm.api_key_header={KEY}"),
    ],
)
def test_a_key_on_the_command_line_is_refused_and_not_shown(command: str, token: str) -> None:
    result = call(command, "llm=openai", token)
    assert result.exit_code == 2
    assert KEY not in result.output
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1
    assert "llm." in result.stderr


def test_the_name_of_a_variable_is_shown() -> None:
    assert "api_key_env: MY_KEY" in call("run", "--cfg", "llm=openai", "llm.api_key_env=MY_KEY").stdout


def test_settings_of_a_model_are_completed() -> None:
    offered = [word for word, _ in complete_override("llm.max_c", TypedLine(overrides=("llm=openai",)))]
    assert [word.partition("=")[0] for word in offered] == ["llm.max_concurrency", "llm.max_cost"]


def test_both_answered_in_form_is_exit_code_0() -> None:
    code, lines = report([asked("negotiate"), asked("decide", subject="CAV2")])
    assert code == 0
    text = "\n".join(lines)
    assert "Decision of CAV2" in text
    for part in ('{"action": "IDLE"}', "json_object", "0.50 s", "400 of the prompt, 30 of the answer", "0.000100 USD"):
        assert part in text
    assert lines[-1] == "Answered in the form asked for."


def test_a_fallback_is_exit_code_1_and_says_why() -> None:
    said = asked("decide", value=None, problem="no JSON object")
    said["calls"] = [{**said["calls"][0], "text": "I would\x1b[31m brake", "cost": None}] * 2
    code, lines = report([asked("negotiate"), said])
    text = "\n".join(lines)
    assert code == 1
    for part in ("none that can be used", "no JSON object", r"I would\x1b[31m brake", "re-asks  1", "no price known"):
        assert part in text
    assert lines[-1] == "No usable answer for the decision: a fallback was needed."


def test_an_order_with_pairs_missing_is_exit_code_1() -> None:
    code, lines = report([asked("negotiate"), asked("decide")], {"repaired_orders": 1})
    assert code == 1
    assert lines[-1] == "The order leaves pairs out or goes in a circle: the rules had to complete it."


def test_nothing_asked_is_no_success() -> None:
    with pytest.raises(ModelError, match="not asked anything"):
        report([])
