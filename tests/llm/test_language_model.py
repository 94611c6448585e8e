"""Settings of a language model: what is refused, and that a process shares one client."""

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hydra.core.override_parser.overrides_parser import OverridesParser

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.errors import ConfigError
from codriving.llm.language_model import LanguageModel, Offline

MODELS = ("openai", "anthropic", "gemini", "ollama", "vllm", "custom")


def model(name: str = "openai", *overrides: str) -> Any:
    return build(compose([f"llm={name}", *overrides])["llm"], object, "llm")


def changed(name: str, override: str) -> Any:
    """The same for one key of the model, read as Hydra reads it, without composing all of the config for it."""
    (read,) = OverridesParser.create().parse_overrides([override])
    return build({**compose([f"llm={name}"])["llm"], read.key_or_group: read.value()}, object, "llm")


@pytest.mark.parametrize("name", MODELS)
def test_choice_is_a_model_with_its_name_in_tables(name: str) -> None:
    made = model(name)
    assert isinstance(made, LanguageModel)
    assert made.name == made.model
    assert made.cache == "off"
    assert (made.api_key_env is None) == (name in ("ollama", "vllm", "custom"))


def test_defaults_of_the_paper() -> None:
    made = model()
    assert (made.model, made.temperature, made.max_tokens) == ("gpt-4o-mini", 0.0, 300)


@pytest.mark.parametrize(
    ("override", "rule"),
    [
        ("model=''", "llm.model must be the name of a model"),
        ("api_base=localhost:8000", "llm.api_base must be an address such as http"),
        ("temperature=3", "llm.temperature must be 0 to 2, got 3"),
        ("max_tokens=0", "llm.max_tokens must be 1 to 100000, got 0"),
        ("deadline=0", "llm.deadline must be 0.1 to 3600 s, got 0"),
        ("attempts=0", "llm.attempts must be 1 to 20, got 0"),
        ("max_concurrency=0", "llm.max_concurrency must be 1 to 1000, got 0"),
        ("cache=maybe", "llm.cache must be one of off, use, replay, got maybe"),
        ("cache_file=''", "llm.cache_file must be the name of a file"),
        ("max_cost=0", "llm.max_cost must be above 0 USD, got 0"),
        ("max_tokens_total=0", "llm.max_tokens_total must be above 0, got 0"),
        ("input_cost_per_token=-1", "llm.input_cost_per_token must be 0 USD or more, got -1"),
        ("input_cost_per_token=1e-6", "llm.input_cost_per_token must be given together with output_cost_per_token"),
        ("failures_in_a_row=0", "llm.failures_in_a_row must be 1 to 1000, got 0"),
    ],
)
def test_what_breaks_a_rule_is_refused_with_key_rule_and_value(override: str, rule: str) -> None:
    with pytest.raises(ConfigError) as refusal:
        changed("openai", override)
    assert str(refusal.value).startswith(rule)


@pytest.mark.parametrize(
    ("name", "override", "rule"),
    [
        (
            "ollama",
            "model=qwen3:0.6b",
            "llm.model must begin with ollama_chat/ here.*set llm.model=ollama_chat/qwen3:0.6b",
        ),
        ("ollama", "model=ollama/qwen3:0.6b", "llm.model must begin with .*set llm.model=ollama_chat/qwen3:0.6b"),
        (
            "gemini",
            "model=gemini-2.5-flash",
            "llm.model must begin with gemini/ here.*set llm.model=gemini/gemini-2.5-flash",
        ),
        ("anthropic", "model=claude-haiku-4-5", "llm.model must begin with .*set llm.model=anthropic/claude-haiku-4-5"),
        ("custom", "system_role=assistant", "llm.system_role must be system, developer or user, got assistant"),
        ("custom", "max_tokens_field=''", "llm.max_tokens_field must be the name of a field"),
        ("custom", "label=' '", "llm.label must be a name or null, got an empty text"),
        ("custom", "fallbacks_at_first=0", "llm.fallbacks_at_first must be 1 to 100000, got 0"),
        ("custom", "extra={model: other}", "llm.extra must not hold model; it is set by llm.model"),
        ("custom", "extra={stream: true}", "llm.extra must not hold stream; it is set by llm.stream"),
        ("custom", "extra={x: inf}", "llm.extra must hold what JSON can hold"),
        ("custom", "headers={X-A: 'ü'}", "llm.headers must hold plain texts, got others under X-A"),
        ("custom", "headers={X-A: 'a\nb: c'}", "llm.headers must hold plain texts, got others under X-A"),
        ("custom", "api_key_header='a:b'", "llm.api_key_header must be names of headers"),
    ],
)
def test_what_a_server_may_want_is_checked(name: str, override: str, rule: str) -> None:
    with pytest.raises(ConfigError) as refusal:
        changed(name, override)
    assert re.match(rule, str(refusal.value)), str(refusal.value)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    "override",
    [
        "extra={api_key: canary-0123}",
        "extra={nested: {list: [{accessToken: canary-0123}]}}",
        "extra={note: 'Bearer canary0123'}",
        "extra={note: sk-canary0123456}",
        "extra={id: canary0123456789abcdefghijklmnopqrst}",
        "extra={id: 0ca0a9ca-ca0a-4ca0-8ca0-ca0a9ca0a9ca}",
        "headers={Authorization: canary}",
        "headers={X-Api-Key: canary}",
        "headers={x-goog-api-key: canary}",
        "headers={X-Team-Secret: canary-0123}",
        "headers={Cookie: canary}",
    ],
)
def test_what_looks_like_a_key_is_refused_and_not_repeated(override: str) -> None:
    with pytest.raises(ConfigError, match=r"must hold no key, .*llm\.api_key_env") as refusal:
        changed("custom", override)
    assert "canary" not in str(refusal.value)


@pytest.mark.parametrize(
    "override",
    [
        "extra={think: false, max_completion_tokens: 300, thinking: {type: enabled, budget_tokens: 1024}}",
        "extra={tokenizer: cl100k, stop_token: '</s>', chat_template_kwargs: {enable_thinking: false}}",
        "extra={temperature: null, provider: {order: [deepinfra, together]}}",
        "headers={X-Title: 'lane change study', anthropic-beta: token-efficient-tools-2025-02-19}",
    ],
)
def test_other_fields_and_headers_are_taken(override: str) -> None:
    made = changed("custom", override)
    assert made.extra or made.headers


def test_a_label_is_the_name_in_tables() -> None:
    assert model("custom", "llm.label=ours").name == "ours"
    assert model("custom", "llm.extra={seed: 1}").chat() is not model("custom", "llm.extra={seed: 2}").chat()


@pytest.mark.parametrize("name", ["ollama", "vllm", "custom"])
def test_servers_on_ones_own_machine_are_asked_four_things_at_once(name: str) -> None:
    assert model(name).max_concurrency == 4


@pytest.mark.parametrize(
    "override",
    ["llm.api_key_env=sk-canary", "llm.api_base='http://me:canary@host/v1'", "llm.api_base='http://h/?k=canary'"],
)
def test_key_in_the_wrong_place_is_refused_and_not_repeated(override: str) -> None:
    with pytest.raises(ConfigError, match=r"the key|not shown") as refusal:
        model("openai", override)
    assert "canary" not in str(refusal.value)


def test_equal_settings_share_a_client_and_others_do_not(tmp_path: Path) -> None:
    base = "llm.api_base=http://127.0.0.1:1/v1"
    shared = model("custom", base).chat()
    assert model("custom", base).chat() is shared
    assert model("custom", base, "llm.ask_plain=true").chat() is shared
    assert model("custom", base, "llm.max_tokens=100").chat() is not shared
    assert shared.name == "openai/default"


def test_building_and_connecting_is_quick_because_nothing_is_imported_yet() -> None:
    code = (
        "import sys; from codriving.config.build import build; from codriving.config.compose import compose; "
        "[build(compose([f'llm={name}'])['llm'], object, 'llm').chat() for name in ('custom', 'local')]; "
        "print([name for name in ('litellm', 'openai', 'xllamacpp') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_offline_has_no_chat() -> None:
    made = model("offline")
    assert isinstance(made, Offline)
    assert made.chat() is None
    assert made.max_concurrency == 1
