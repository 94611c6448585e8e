"""The swept keys that need a column: those that scenario, method, variant and reasoner do not show."""

from codriving.experiment.cells import shown_apart, swept_values
from codriving.experiment.episode import Labels


def labels(
    scenario: str = "intersection", method: str = "codriving", variant: str = "full", who: str = "rules"
) -> Labels:
    return Labels(scenario, method, variant, who)


def test_a_value_is_the_configs_and_a_choice_has_its_name() -> None:
    config = {"scenario": {"cavs": 4, "hdvs": [2, 4], "name": "x y", "rain": True, "free": None}, "cda": {"a": 1}}
    typed = {"scenario.cavs": "4", "scenario.hdvs": "[2,4]", "scenario.name": "'x y'", "scenario.rain": "TRUE"}
    assert swept_values({**typed, "scenario.free": "null", "cda": "full"}, config) == {
        "scenario.cavs": "4",
        "scenario.hdvs": "[2, 4]",
        "scenario.name": "x y",
        "scenario.rain": "true",
        "scenario.free": "null",
        "cda": "full",
    }
    assert swept_values({"scenario.hdvs.1": "4"}, config) == {"scenario.hdvs.1": "4"}


def test_a_secret_is_never_shown() -> None:
    config = {"llm": {"api_key": "sk-canary", "max_tokens": 100}}
    assert swept_values({"llm.api_key": "sk-canary", "llm.max_tokens": "100"}, config) == {
        "llm.api_key": "<redacted>",
        "llm.max_tokens": "100",
    }


def test_choices_that_a_label_shows_need_no_column() -> None:
    cells = [
        (labels(scenario, method, variant), {"scenario": scenario, "method": method, "cda": cda})
        for scenario in ("intersection", "merge")
        for method in ("codriving", "other")
        for cda, variant in (("full", "full"), ("status_sharing", "no_x"))
    ]
    assert shown_apart(cells) == [{}] * len(cells)


def test_settings_do_even_beside_labels() -> None:
    cells = [(labels(s), {"scenario": s, "scenario.cavs": n}) for s in ("intersection", "merge") for n in ("4", "8")]
    assert shown_apart(cells) == [{"scenario.cavs": n} for _, swept in cells for n in [swept["scenario.cavs"]]]


def test_a_choice_that_its_label_does_not_show_gets_a_column_of_another_name() -> None:
    files = [(labels(), {"scenario": name}) for name in ("intersection", "my_dense_intersection")]
    assert shown_apart(files) == [{"scenario_choice": "intersection"}, {"scenario_choice": "my_dense_intersection"}]
    orders = [(labels(), {"cda.own_order": name}) for name in ("own_view", "same_rule")]
    assert shown_apart(orders) == [{"cda.own_order": "own_view"}, {"cda.own_order": "same_rule"}]
    shown = [(labels(variant=f"no_negotiation/{n}"), {"cda.own_order": n}) for n in ("own_view", "same_rule")]
    assert shown_apart(shown) == [{}, {}]
    assert shown_apart([(labels(), {"metrics": m}) for m in ("standard", "authors")])[1] == {"metrics": "authors"}


def test_the_reasoner_shows_the_model_but_not_its_temperature() -> None:
    cells = [
        (labels(who=model), {"llm": model, "llm.temperature": t}) for model in ("rules", "gpt") for t in ("0", "1")
    ]
    assert shown_apart(cells)[0] == {"llm.temperature": "0"}


def test_a_key_with_one_value_left_needs_no_column() -> None:
    assert shown_apart([(labels(), {"cda": "full"})]) == [{}]
    assert shown_apart([]) == []
