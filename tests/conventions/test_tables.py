"""Tables of the pages are made from the numbers that are kept beside the program that makes them."""

import json
import runpy
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = runpy.run_path(str(ROOT / "docs" / "tables" / "__main__.py"))

SPEC = {
    "runs": {"old": ["old"], "new": ["new", "more"]},
    "only": {"scenario": "intersection"},
    "columns": {
        "method": "`{method}` {variant}",
        "success": "{old.success_rate:%}, {new.success_rate:%}",
        "PET [s]": "{new.pet_mean:.1f}",
    },
    "more": [["*the paper*", "*90 %*", "*10.3*"]],
}


def keep(folder: Path, name: str, behaviour: int, *rows: str) -> None:
    made = {"command": f"run of={name}", "version": "0.2.0", "behaviour": behaviour}
    head = "scenario,method,variant,success_rate,pet_mean"
    (folder / f"{name}.csv").write_text("\n".join((f"# {json.dumps(made)}", head, *rows)) + "\n", encoding="utf-8")


@pytest.fixture
def made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    keep(tmp_path, "old", 2, "intersection,codriving,full,0.98125,4.86", "intersection,fcfs,,0.99,5", "merge,fcfs,,1,5")
    keep(tmp_path, "new", 3, "intersection,fcfs,,1,", "intersection,codriving,full,0.5,7.449")
    keep(tmp_path, "more", 3, "intersection,mcts,,0.25,2.04")
    for names in (PROGRAM["markdown"].__globals__, PROGRAM["main"].__globals__):
        monkeypatch.setitem(names, "HERE", tmp_path)
        monkeypatch.setitem(names, "ROOT", tmp_path)
        monkeypatch.setitem(names, "PAGES", ("page.md",))
    return tmp_path


TABLE = """<!-- table one: made by make tables -->
| method | success | PET [s] |
|---|---:|---:|
| `codriving` full | 98.1 %, 50 % | 7.4 |
| `fcfs` | 99 %, 100 % | |
| `mcts` | | 2.0 |
| *the paper* | *90 %* | *10.3* |

From

- `codriving run of=old` (version 0.2.0, behaviour 2)
- `codriving run of=new` (version 0.2.0, behaviour 3)
- `codriving run of=more` (version 0.2.0, behaviour 3)
<!-- end of table one -->"""


@pytest.mark.parametrize(
    ("run", "methods"),
    [
        ("old", ["codriving", "fcfs", "fcfs"]),
        ("old scenario=intersection", ["codriving", "fcfs"]),
        ("old method!=codriving", ["fcfs", "fcfs"]),
        ("old scenario=intersection method!=codriving", ["fcfs"]),
    ],
)
def test_some_rows_of_a_run_are_taken(made: Path, run: str, methods: list[str]) -> None:
    assert [row["method"] for row in PROGRAM["rows_of"](run).rows] == methods


def test_rows_of_several_runs_stand_side_by_side_with_what_made_them(made: Path) -> None:
    assert PROGRAM["markdown"]("one", SPEC) == TABLE


def test_rows_of_a_benchmark_are_one_a_scenario_below_the_command_as_it_is_typed(made: Path) -> None:
    rows = [{"scenario": s, "world": w, "braking": b} for s, w, b in (("merge", "x", 8.0), ("merge", "y", 7.5))]
    text = PROGRAM["wide"](rows)
    assert text == "scenario,method,variant,x_braking,y_braking\nmerge,codriving,,8.0,7.5\n"
    about = {"command": "bench --only worlds", "version": "0.2.0", "behaviour": 3}
    PROGRAM["keep"](made / "limits.csv", about, text)
    spec = {"runs": {"found": ["limits"]}, "columns": {"at": "{scenario}", "y": "{found.y_braking:.1f}"}}
    lines = PROGRAM["markdown"]("one", spec).splitlines()
    assert lines[3:6] == ["| merge | 7.5 |", "", 'From `make bench ARGS="--only worlds"` (version 0.2.0, behaviour 3).']


def test_each_level_is_kept_with_the_breaking_points_of_its_curve() -> None:
    levels = "axis,method,level,success_rate\nage,fcfs,0,1\nage,fcfs,1,0.5\nloss,fcfs,0,1\n"
    curves = "axis,method,success_breaks_at,success_area,clean_breaks_at\nloss,fcfs,never,1,30\nage,fcfs,0.5,0.7,\n"
    assert PROGRAM["with_breaking"](levels, curves) == (
        "axis,method,level,success_rate,success_breaks_at,clean_breaks_at\n"
        "age,fcfs,0,1,0.5,\nage,fcfs,1,0.5,0.5,\nloss,fcfs,0,1,never,30\n"
    )


@pytest.mark.parametrize("page", ["README.md", "docs/results.md", "docs/stress.md"])
def test_what_is_measured_stands_in_tables_that_are_made(page: str) -> None:
    by_hand = PROGRAM["TABLE"].sub("", (ROOT / page).read_text(encoding="utf-8"))
    heads = [line for line in by_hand.splitlines() if line.startswith("|---")]
    # Tables of words, whose columns are not aligned as numbers are, may be written by hand.
    assert not [head for head in heads if "--:" in head]


def write(folder: Path, page: str, spec: Mapping[str, Any]) -> None:
    (folder / "page.md").write_text(page, encoding="utf-8")
    (folder / "tables.yaml").write_text(json.dumps({"runs": {}, "tables": spec}), encoding="utf-8")


def test_page_gets_the_numbers_that_are_kept_and_a_number_changed_by_hand_is_found(
    made: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(made, f"Before.\n\n{TABLE.replace('98.1', '99.9')}\n\nAfter.\n", {"one": SPEC})
    assert PROGRAM["main"](["--check"]) == 1
    assert capsys.readouterr().err == "not as make tables writes them: page.md\n"
    assert PROGRAM["main"](["--pages"]) == 0
    assert (made / "page.md").read_text(encoding="utf-8") == f"Before.\n\n{TABLE}\n\nAfter.\n"
    assert PROGRAM["main"](["--check"]) == 0


@pytest.mark.parametrize(
    ("spec", "arguments", "said"),
    [
        ({}, ["--pages"], "page.md has a table 'one', but tables.yaml does not"),
        ({"one": {**SPEC, "runs": {"new": ["none"]}}}, ["--pages"], "none.csv is not there: make tables"),
        ({"one": {**SPEC, "only": {"method": "idfst"}}}, ["--pages"], "table one has no rows"),
        ({"one": SPEC}, ["other"], "no run other in tables.yaml"),
    ],
)
def test_what_cannot_be_made_is_said_in_one_line(
    made: Path, capsys: pytest.CaptureFixture[str], spec: Mapping[str, Any], arguments: list[str], said: str
) -> None:
    write(made, TABLE, spec)
    assert PROGRAM["main"](arguments) == 1
    shown = capsys.readouterr().err
    assert said in shown
    assert shown.count("\n") == 1


def test_tables_of_the_pages_are_as_they_are_made() -> None:
    assert PROGRAM["main"](["--check"]) == 0


def test_suites_of_one_run_stand_side_by_side(made: Path) -> None:
    first = {"command": "compare all", "version": "0.2.0", "behaviour": 5}
    rows = ("method,suite,success_rate", "codriving,crowd,0.5", "codriving,blind,0.75", "fcfs,blind,1")
    (made / "hard.csv").write_text("\n".join((f"# {json.dumps(first)}", *rows)) + "\n", encoding="utf-8")
    spec = {
        "by": ["method"],
        "runs": {"crowd": ["hard suite=crowd"], "blind": ["hard suite=blind"]},
        "columns": {
            "method": "{method}",
            "both": "{crowd.success_rate:%}, {blind.success_rate:%}",
            "x": "{blind.success_rate:%}",
        },
    }
    table = PROGRAM["markdown"]("two", spec).splitlines()
    assert table[1:6] == [
        "| method | both | x |",
        "|---|---:|---:|",
        "| codriving | 50 %, 75 % | 75 % |",
        "| fcfs | | 100 % |",
        "",
    ]
    assert table[6] == "From `codriving compare all` (version 0.2.0, behaviour 5)."
    spec["runs"] = {"crowd": ["hard suite=crowd"], "blind": ["hard"]}
    with pytest.raises(Exception, match="blind has two rows codriving: take some of the run, or add a key to by:"):
        PROGRAM["markdown"]("two", spec)


def test_figure_shows_the_rows_of_its_table(made: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "docs" / "tables"))
    pictures, numbers = [], ["0.5", "0.4", "0.7", "0.2", "0.1", "0.3"]
    for changed in (None, None, *range(len(numbers))):
        head = "method,success_rate,success_low,success_high,clean_rate,clean_low,clean_high"
        found = ("0.55" if k == changed else number for k, number in enumerate(numbers))
        rows = (head, f"codriving,{','.join(found)}", "fcfs,1,0.9,1,0,0,0.1")
        (made / "hard.csv").write_text("\n".join(('# {"command": "", "version": "", "behaviour": 5}', *rows)) + "\n")
        PROGRAM["draw"]("hard", {"by": ["method"], "runs": {"crowd": ["hard"]}}, made / "hard.svg")
        pictures.append((made / "hard.svg").read_text(encoding="utf-8"))
    assert pictures[0] == pictures[1]
    assert len(set(pictures)) == 1 + len(numbers)
    assert all(f"<!-- {text} -->" in pictures[0] for text in ("crowd", "codriving", "fcfs", "clean success"))


def test_a_part_of_a_cell_is_left_out_where_there_is_no_number() -> None:
    cells = PROGRAM["Cells"]()
    assert cells.cell("{a:%}{b:?, %.1f s}", {"a": 0.5, "b": 4.26}) == "50 %, 4.3 s"
    assert cells.cell("{a:%}{b:?, %.1f s}", {"a": 0.5, "b": None}) == "50 %"
