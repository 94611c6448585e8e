"""`codriving exam`: a row for the rules, the controls and what llm= names, and every answer kept."""

import csv
import json
from pathlib import Path

import pytest
from small_exam import small_exam
from typer.testing import CliRunner, Result

from codriving.cli.app import app
from codriving.exam.file import written_exam


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("exam") / "small.jsonl.xz"
    path.write_bytes(written_exam(small_exam()))
    return path


def call(*args: object) -> Result:
    return CliRunner().invoke(app, ["exam", *map(str, args)])


def test_rows_and_answers(file: Path, tmp_path: Path) -> None:
    exam = small_exam()
    result = call("epochs=2", f"output={tmp_path}", "run=one", "--file", file)
    assert result.exit_code == 0, result.output
    folder = tmp_path / "exam" / "one"
    assert result.stdout.endswith(f"{folder / 'exam.csv'}\n")
    with (folder / "exam.csv").open(encoding="utf-8", newline="") as of:
        rows = {row["reasoner"]: row for row in csv.DictReader(of)}
    assert list(rows) == ["rules", "control first", "control random"]
    whole = len(exam.situations) + len(exam.negotiations)
    assert {(row["questions"], row["situations"]) for row in rows.values()} == {(str(whole), str(len(exam.situations)))}
    rules, first = rows["rules"], rows["control first"]
    assert (rules["asked"], rules["tokens"], rules["in_form_rate"]) == ("0", "", "")
    assert (first["in_form_rate"], first["unusable_rate"], first["same_rate"], first["epochs"]) == ("1", "0", "1", "2")
    assert first["forms"] == "json_schema"
    assert float(first["acceptable_low"]) <= float(first["acceptable_rate"]) <= float(first["acceptable_high"])
    # Of the small exam's pairs the one that is named first is the better one, as this control says.
    assert first["pairs_acceptable_rate"] == "1"
    lines = [json.loads(line) for line in (folder / "answers.jsonl").read_text(encoding="utf-8").splitlines()]
    assert len(lines) == whole * (1 + 2 + 2)
    assert {line["reasoner"] for line in lines} == set(rows)
    page = (folder / "exam.md").read_text(encoding="utf-8")
    assert "| rules (llm=offline) |" in page
    assert "Same: of the questions that were asked again" in page


def test_some_questions_and_no_controls(file: Path, tmp_path: Path) -> None:
    result = call("controls=false", f"output={tmp_path}", "--most", "5", "--file", file)
    assert result.exit_code == 0, result.output
    assert "5 questions, evenly taken of all, of " in result.stdout
    assert "control" not in result.stdout.partition("\n")[2].partition("Safe:")[0]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            ["scenario=merge"],
            "an exam takes llm, epochs, prompts, output, run and controls, and its world from",
        ),
        (["llm=nomodel"], "unknown llm 'nomodel'"),
        (["epochs=0"], "epochs must be a whole number of 1 to 100"),
        (["controls=maybe"], "controls must be true or false"),
        (["--most", "0"], "--most must be 1 or more, got 0"),
        (["--file", "none.xz"], "none.xz cannot be read ("),
        (["llm=vllm", "llm.api_base=http://127.0.0.1:9/v1", "llm.attempts=1"], "127.0.0.1:9"),
    ],
)
def test_a_mistake_is_one_line(words: list[str], said: str, file: Path, tmp_path: Path) -> None:
    given = words if "--file" in words else [*words, "--file", str(file)]
    result = call(f"output={tmp_path}", *given)
    assert result.exit_code == 2
    assert said in result.stderr
    assert result.stderr.count("error: ") == 1
    assert not list(tmp_path.glob("exam/*/*"))
