"""The printed table: ours beside the paper's, plain in a pipe, and the same in Markdown."""

from collections.abc import Callable
from pathlib import Path

import pytest

from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.reports.paper import ABLATION, COMPARISON, Paper, read_paper
from codriving.reports.printed import markdown_text
from codriving.reports.results import CellResults
from codriving.reports.summary import print_summary
from tests.reports.making import print_cells, printed_text

COMPARED = "scenario,method,label,success_rate,pet_mean,pet_max,pet_min,velocity_mean,velocity_max,velocity_min\n"


@pytest.fixture
def paper(tmp_path: Path) -> Paper:
    (tmp_path / COMPARISON).write_text(COMPARED + "intersection,codriving,CoDrivingLLM,0.90,10.3,44.0,1.8,5.7,8.0,\n")
    (tmp_path / ABLATION).write_text(
        "scenario,variant,statement,success_low,success_high\n"
        "intersection,full,90 %,0.9,0.9\nintersection,no_negotiation,below 15 %,0.0,0.15\n"
        "merge,full,,,\nmerge,no_state_sharing,close to the full method,0.5,1.0\nmerge,no_negotiation,,,\n"
    )
    return read_paper(tmp_path)


def test_a_pipe_gets_plain_text_with_the_papers_row_beside_ours(
    make: Callable[..., EpisodeRecord], paper: Paper
) -> None:
    rows = [CellResults([make(seed, pets=(2.0, 4.0), velocities=(7.0,)) for seed in range(20)])]
    text = printed_text(print_summary(rows, paper))
    assert text.isascii()
    assert "\x1b" not in text
    title, head, ours, theirs, note = (" ".join(line.split()) for line in text.splitlines())
    assert title == "intersection - reasoner: rules (llm=offline)"
    assert head.split()[0] == "method"
    assert ours.split()[:4] == ["codriving", "full", "20", "100"]
    assert "83.9 to 100 %" in ours
    assert ours.endswith("3.0 / 4.0 / 2.0 0 % 7.0 / 7.0 / 7.0")
    assert theirs.startswith("paper: CoDrivingLLM")
    assert theirs.endswith("10.3 / 44.0 / 1.8 5.7 / 8.0 / -")
    assert "Wilson" in note


def test_the_title_names_definitions_that_are_not_ours(make: Callable[..., EpisodeRecord], paper: Paper) -> None:
    rows = [CellResults([make(0)])]
    assert print_summary(rows, paper, "authors").title.endswith("metrics: authors")
    assert "metrics" not in print_summary(rows, paper, "standard").title


def test_the_ablation_has_the_papers_words_beside_each_reading(
    make: Callable[..., EpisodeRecord], paper: Paper
) -> None:
    rows = [CellResults([make(0, variant=v)]) for v in ("full", "no_negotiation/own_view", "no_safety_check")]
    table = print_summary(rows, paper)
    assert table.columns[-1] == "the paper says"
    assert [line.cells[-1] for line in table.rows if line.ours] == ["90 %", "below 15 %", ""]
    assert sum(not line.ours for line in table.rows) == 1


def test_each_scenario_has_its_own_statements_and_its_rows_end_with_a_line(
    make: Callable[..., EpisodeRecord], paper: Paper
) -> None:
    variants = ("full", "no_state_sharing", "no_negotiation/same_rule")
    rows = [CellResults([make(0, variant=v, scenario=s)]) for s in ("intersection", "merge") for v in variants]
    table = print_summary(rows, paper)
    said = [(line.cells[0], line.cells[-1]) for line in table.rows if line.ours]
    assert said == [
        ("intersection", "90 %"),
        ("intersection", ""),
        ("intersection", "below 15 %"),
        ("merge", ""),
        ("merge", "close to the full method"),
        ("merge", ""),
    ]
    assert [line.last for line in table.rows] == [False, False, False, True, False, False, False]


def test_the_paper_says_nothing_of_a_sweep_in_which_nothing_is_removed(
    make: Callable[..., EpisodeRecord], paper: Paper
) -> None:
    whole = [CellResults([make(0, variant=v, scenario=s)]) for s in ("intersection", "merge") for v in ("full", "")]
    assert "the paper says" not in print_summary(whole, paper).columns
    binding = [CellResults([make(0, variant=v)]) for v in ("full/binding", "no_negotiation")]
    assert [line.cells[-1] for line in print_summary(binding, paper).rows] == ["", "below 15 %"]


def test_swept_keys_stand_beside_the_method_and_the_papers_row_below_the_last_of_ours(
    make: Callable[..., EpisodeRecord], paper: Paper
) -> None:
    cells = [{"scenario.cavs": str(cavs), "cda.own_order": order} for cavs in (4, 8) for order in ("own_view", "[x]")]
    rows = [CellResults([make(0)], swept) for swept in cells]
    table = print_summary(rows, paper, swept=("scenario.cavs", "cda.own_order"), notes=("a note",))
    assert table.columns[:4] == ("method", "scenario.cavs", "cda.own_order", "episodes")
    assert [line.cells[1:3] for line in table.rows if line.ours] == [tuple(cell.values()) for cell in cells]
    assert [line.ours for line in table.rows] == [True] * 4 + [False]
    assert table.rows[-1].cells[:3] == ("paper: CoDrivingLLM", "", "")
    assert "cda.own_order" in table.words
    assert "scenario.cavs" not in table.words
    assert table.notes[-1] == "a note"
    assert printed_text(table).splitlines()[-1] == "a note"
    lines = markdown_text(table).splitlines()
    assert lines[2].startswith("| method | scenario.cavs | cda.own_order | episodes |")
    assert lines[3].startswith("| --- | ---: | --- | ---: |")
    assert lines[-1] == "a note"


def test_a_pipe_never_wraps_a_wide_table(make: Callable[..., EpisodeRecord]) -> None:
    swept = {f"environment.drivers.key_{index}": "1.5" for index in range(8)}
    table = print_summary([CellResults([make(0)], swept)], Paper(), swept=tuple(swept))
    assert len(printed_text(table).splitlines()) == 4


def test_scenarios_and_errors_have_columns_only_where_there_are_some(make: Callable[..., EpisodeRecord]) -> None:
    one = print_summary([CellResults([make(0)])], Paper())
    assert not {"scenario", "error", "off road", "the paper says"} & set(one.columns)
    two = print_summary([CellResults([make(0)]), CellResults([make(0, Ending.ERROR, scenario="merge")])], Paper())
    assert two.columns[0] == "scenario"
    assert "error" in two.columns
    assert two.rows[1].cells[2] == "0/1"
    assert two.title.startswith("intersection, merge - ")


def test_a_model_is_named_without_the_word_offline(make: Callable[..., EpisodeRecord]) -> None:
    assert print_cells([make(0, reasoner="gpt-4o-mini")]).title == "intersection - reasoner: gpt-4o-mini"


def test_text_is_never_taken_for_markup(make: Callable[..., EpisodeRecord]) -> None:
    table = print_cells([make(0, variant="[bold]|x")])
    assert "codriving [bold]|x" in printed_text(table)
    assert "codriving [bold]\\|x" in markdown_text(table)


def test_markdown_has_the_same_rows(make: Callable[..., EpisodeRecord], paper: Paper) -> None:
    lines = markdown_text(print_summary([CellResults([make(0)])], paper)).splitlines()
    assert lines[0] == "# intersection - reasoner: rules (llm=offline)"
    assert lines[3].startswith("| --- | ---: |")
    assert lines[4].startswith("| codriving full | 1 | 100 % |")
    assert lines[5].startswith("| *paper: CoDrivingLLM* | *20* | *90 %* |  |")
    assert len({line.count("|") for line in lines[2:6]}) == 1


def test_a_missing_paper_is_no_paper(tmp_path: Path) -> None:
    assert read_paper(tmp_path) == Paper()


def test_rules_in_the_place_of_a_model_are_not_that_method(make: Callable[..., EpisodeRecord], paper: Paper) -> None:
    said = "dilu-rule: built-in rules in the place of dilu's language model; it is not that method."
    assert said in print_summary([CellResults([make(0, method="dilu-rule")])], paper).notes
    assert said not in print_summary([CellResults([make(0, method="dilu")])], paper).notes


def test_what_has_to_be_known_of_a_method_is_said_once(make: Callable[..., EpisodeRecord], paper: Paper) -> None:
    cells = [CellResults([make(0, scenario=name)], remark="madqn: trained elsewhere.") for name in ("merge", "highway")]
    assert print_summary(cells, paper).notes.count("madqn: trained elsewhere.") == 1
    assert "" not in print_summary([CellResults([make(0)])], paper).notes


def test_the_papers_row_stands_below_its_own_setting_and_seeds_alone(
    make: Callable[..., EpisodeRecord], paper: Paper
) -> None:
    def lines(**told: bool) -> list[tuple[bool, str]]:
        cells = [CellResults([make(0, variant=v)], **told) for v in ("full", "no_negotiation")]
        table = print_summary(cells, paper)
        said = "the paper says" in table.columns
        return [(row.ours, row.cells[-1] if said else "") for row in table.rows]

    assert lines() == [(True, "90 %"), (False, ""), (True, "below 15 %")]
    assert lines(as_in_paper=False) == [(True, "90 %"), (True, "below 15 %")]
    assert lines(as_in_paper=False, papers_setting=False) == [(True, ""), (True, "")]


def test_two_models_are_told_apart_in_each_row(make: Callable[..., EpisodeRecord]) -> None:
    def shown(*reasoners: str) -> list[str]:
        table = print_cells(*([make(0, reasoner=reasoner)] for reasoner in reasoners))
        where = table.columns.index("reasoner") if "reasoner" in table.columns else None
        return [] if where is None else [row.cells[where] for row in table.rows]

    assert shown("openai/gpt-4o", "openai/gpt-4o-mini") == ["gpt-4o", "gpt-4o-mini"]
    assert shown("openai/a", "ollama_chat/a", "rules") == ["openai/a", "ollama_chat/a", "rules"]
    assert shown("rules") == []
    assert shown("openai/meta/llama", "openai/gpt-4o") == ["meta/llama", "gpt-4o"]


def test_settings_of_one_model_need_no_reasoner(make: Callable[..., EpisodeRecord]) -> None:
    cells = [CellResults([make(0, reasoner="a/b")], {"llm.temperature": t}) for t in ("0", "1")]
    assert print_summary(cells, Paper(), swept=("llm.temperature",)).columns[:3] == (
        "method", "llm.temperature", "episodes"
    )  # fmt: skip
