"""Secrets are masked, everything else stays."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.runs.redaction import MASK, flat, nested, redact

names = st.text("abc_", min_size=1, max_size=4)
leaves = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text()


def test_values_under_secret_names_are_masked_at_any_depth() -> None:
    settings = {"llm": {"api_key": "sk-1", "headers": [{"X-Secret": "s"}], "TOKEN": ["t"], "model": "m"}}
    assert redact(settings) == {
        "llm": {"api_key": MASK, "headers": [{"X-Secret": MASK}], "TOKEN": [MASK], "model": "m"}
    }


def test_numbers_switches_and_names_of_variables_stay() -> None:
    settings = {"max_tokens": 500, "use_key": True, "api_key": None, "api_key_env": "OPENAI_API_KEY", "keyword": ""}
    assert redact(settings) == settings


def test_a_key_in_the_place_of_its_variables_name_is_masked() -> None:
    assert redact({"api_key_env": "sk-9d8f7a6s5d4f"}) == {"api_key_env": MASK}


def test_flattening_gives_a_line_a_setting() -> None:
    assert flat({"scenario": {"cavs": 4, "speeds": [0, 8]}, "run": None, "memory": {}}) == {
        "scenario.cavs": "4",
        "scenario.speeds": "[0, 8]",
        "run": "null",
        "memory": "{}",
    }


@settings(max_examples=30)
@given(
    st.dictionaries(
        names,
        st.recursive(leaves | st.lists(leaves, max_size=3), lambda inner: st.dictionaries(names, inner), max_leaves=6),
        max_size=4,
    )
)
def test_nesting_undoes_flattening(config: dict[str, object]) -> None:
    assert nested(flat(config)) == config


def test_a_value_that_holds_others_is_refused() -> None:
    with pytest.raises(ValueError, match=r"scenario\.cavs lies below a value"):
        nested({"scenario": "3", "scenario.cavs": "4"})


def test_of_the_fields_of_a_request_only_what_may_be_a_key_is_masked() -> None:
    fields = {"stop_token": "</s>", "tokenizer": "cl100k_base", "inner": {"access_token": "9d8f7a6s5d4f"}}
    model = {"extra": fields, "max_tokens_field": "max_completion_tokens", "api_key_header": "X-Team-Key"}
    assert redact({"llm": model}) == {"llm": {**model, "extra": {**fields, "inner": {"access_token": MASK}}}}
