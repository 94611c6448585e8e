"""Files of experiments: ours, and those of a user's that are refused in a line."""

import csv
import re
from pathlib import Path

import pytest

from codriving.config.compose import compose
from codriving.config.experiments import experiment_file, experiment_names
from codriving.config.locate import experiments_dir
from codriving.errors import ConfigError

GOOD = """# With and without negotiation.
set: [suite=honest, episodes=4]
rows:
  negotiated: []
  each for itself: [cda.negotiation=false, cda.binding=false]
columns:
  light: [scenario.cavs=2]
  dense: [scenario.cavs=6]
"""

PAPERS = ("ablation", "case_memory", "case_negotiation", "comparison", "learning", "single_vehicle")


def own(folder: Path, text: str, name: str = "mine") -> Path:
    (folder / "experiments").mkdir(exist_ok=True)
    file = folder / "experiments" / f"{name}.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_a_file_says_rows_columns_and_what_all_have_in_common(tmp_path: Path) -> None:
    file = own(tmp_path, GOOD)
    for name, folder in (("mine", tmp_path), (str(file), None)):
        read = experiment_file(name, folder)
        assert (read.name, read.sentence, read.table) == ("mine", "With and without negotiation.", "rows")
        assert read.rows == {"negotiated": (), "each for itself": ("cda.negotiation=false", "cda.binding=false")}
    common, columns = read.settings(())
    assert common == ["experiment=mine", "suite=honest", "episodes=4"]
    assert columns == {"light": ("scenario.cavs=2",), "dense": ("scenario.cavs=6",)}
    common, columns = read.settings({"scenario.cavs", "suite", "experiment"})
    assert common == ["episodes=4"]
    assert columns == {"light": ()}, "columns that the command line makes the same are one"
    assert "mine" in experiment_names(tmp_path)


def test_a_file_like_another_one_says_what_is_different(tmp_path: Path) -> None:
    own(tmp_path, GOOD)
    own(
        tmp_path,
        "# The same in a crowd.\nlike: mine\nset: [suite=crowd]\ncolumns:\n  eight: [scenario.cavs=8]\n",
        "second",
    )
    read = experiment_file("second", tmp_path)
    assert read.common == ("episodes=4", "suite=crowd")
    assert list(read.rows) == ["negotiated", "each for itself"]
    assert list(read.columns) == ["eight"]
    assert read.settings(())[0][0] == "experiment=second", "its runs have a folder of their own"


def test_what_the_paper_shows_has_a_file_each_in_its_world_with_its_numbers_beside() -> None:
    files = {name: experiment_file(name) for name in experiment_names()}
    assert tuple(sorted(name for name, file in files.items() if file.shows)) == PAPERS
    for name in PAPERS:
        file = files[name]
        assert {"suite=paper", "episodes=20", "seed=0"} <= set(file.common), name
        with (experiments_dir() / file.numbers).open(encoding="utf-8", newline="") as numbers:
            assert list(csv.DictReader(numbers))
    assert list(files["ablation"].columns) == ["intersection", "roundabout", "highway", "merge"]
    assert files["ablation"].rows == files["ablate"].rows


def test_experiments_in_a_config_stands_for_what_the_file_sets(tmp_path: Path) -> None:
    own(tmp_path, GOOD)
    config = compose(["experiments=mine", "episodes=7"], tmp_path)
    assert (config["experiment"], config["episodes"]) == ("mine", 7)
    assert compose(["experiments=comparison", "suite=default"])["limits"] is not None, "the command line wins"
    own(tmp_path, "# @package _global_\n# Mine.\nepisodes: 3\n", "changes")
    assert compose(["experiments=changes"], tmp_path)["episodes"] == 3
    with pytest.raises(ConfigError, match="changes is a set of changes and has no rows; write"):
        experiment_file("changes", tmp_path)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("rows:", "stuff:", "unknown key stuff; keys of an experiment: case, columns, like, paper, rows, set, table"),
        ("columns:", "colums:", "unknown key colums; did you mean columns?"),
        ("# With and", "with: and", "must begin with a sentence"),
        ("  each for itself", "  negotiated", "'negotiated' stands twice, on lines 4 and 5; give each row"),
        ("  dense", "  light", "'light' stands twice, on lines 7 and 8"),
        ("[scenario.cavs=6]", "[scenario.cavs=2]", "columns.dense sets the same as light; leave one of them out"),
        ("[scenario.cavs=6]", "scenario.cavs=6", "columns.dense must be a list of key=value, got 'scenario.cavs=6'"),
        ("[scenario.cavs=6]", "[scenario.cavs]", "columns.dense: scenario.cavs stands alone; write key and value"),
        ("[scenario.cavs=6]", "[senario=merge]", "columns.dense: unknown key senario; did you mean scenario?"),
        ("[scenario.cavs=6]", '["scenario.cavs=6,8"]', "columns.dense: scenario.cavs takes one value here"),
        ("[scenario.cavs=6]", "[scenario=all]", "columns.dense: scenario takes one value here"),
        ("[scenario.cavs=6]", "[seed=3]", "columns.dense: seed belongs to the run as a whole; write it below set"),
        ("[scenario.cavs=6]", "[controls=true]", "columns.dense: controls holds for all of it; write it below set"),
        ("  light", "  2", "columns: 2 is no name; take a text"),
        ("rows:", "table: pie\nrows:", "table must be one of rows, ablation, learning, baselines, "),
        ("rows:", "table: learning\nrows:", "table: learning finds its rows by itself; leave rows out"),
        ("rows:", "table: baselines\nrows:", "rows.negotiated must be [method=NAME], since table: baselines c"),
        ("rows:", "like: nothing\nrows:", "like must name an experiment, got 'nothing'; experiments: ablate, "),
        ("rows:", "case: maybe\nrows:", "case must be true or false, got 'maybe'"),
        ("rows:", "paper: {numbers: none.csv}\nrows:", "paper.numbers must be the name of a CSV beside it, and"),
        ("rows:", "paper: {of: Fig}\nrows:", "paper: unknown key of; keys of paper: numbers, shows"),
        ("rows:", "rows: [", "cannot be read ("),
    ],
)  # fmt: skip
def test_what_is_wrong_in_a_file_is_said_in_a_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    file = own(tmp_path, GOOD.replace(old, new, 1))
    with pytest.raises(ConfigError, match=re.escape(said)) as refused:
        experiment_file("mine", tmp_path)
    assert str(file) in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("rows", ["rows: {}\n", "rows:\n", "rows: []\n", ""])
def test_a_file_without_rows_is_refused(tmp_path: Path, rows: str) -> None:
    own(tmp_path, f"# Nothing.\n{rows}")
    with pytest.raises(ConfigError, match=r"mine\.yaml.* rows (must name at least one|is missing)|must hold rows"):
        experiment_file("mine", tmp_path)


def test_what_there_is_not_is_said_with_what_there_is(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"unknown experiment 'abblation'; write codriving experiment NAME\|FILE"):
        experiment_file("abblation")
    with pytest.raises(ConfigError, match=r"there is no file nowhere/mine.yaml; name one, or one of: ablate, "):
        experiment_file("nowhere/mine.yaml")
    own(tmp_path, "# One.\nlike: two\n", "one")
    own(tmp_path, "# Two.\nlike: one\n", "two")
    with pytest.raises(ConfigError, match=r"like: one leads back to the file itself|like: two leads back"):
        experiment_file("one", tmp_path)
    own(tmp_path, GOOD, "ablate")
    with pytest.raises(ConfigError, match="has the name of a built-in experiments; give it another name"):
        experiment_file("one", tmp_path)
