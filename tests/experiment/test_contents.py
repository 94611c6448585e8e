"""What a cell is told by beside names and values: files that its config names, and what its plug-ins import."""

import sys
from pathlib import Path

import pytest

from codriving.experiment.contents import contents


@pytest.fixture
def beside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of a user's, on the search path."""
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "their_roads.py").write_text("import math\nfrom their_shapes.arcs import bow\nimport numpy as np\n")
    (tmp_path / "their_shapes" / "deep").mkdir(parents=True)
    (tmp_path / "their_shapes" / "__init__.py").write_text("")
    (tmp_path / "their_shapes" / "arcs.py").write_text("import their_numbers, their_roads\nbow = 1\n")
    (tmp_path / "their_shapes" / "deep" / "er.py").write_text("")
    (tmp_path / "their_numbers.py").write_text("import their_lost_one\n")
    (tmp_path / "their_other.py").write_text("")
    return tmp_path


def names(resolved: dict[str, object]) -> list[str]:
    return sorted(file.name for file in contents({"memory": None, **resolved}, {}))


def test_what_a_plug_in_imports_from_beside_it_is_part_of_it_and_is_not_run(beside: Path) -> None:
    assert names({"plugins": ["their_roads"]}) == [
        "plug-in their_numbers.py",
        "plug-in their_roads.py",
        "plug-in their_shapes/__init__.py",
        "plug-in their_shapes/arcs.py",
        "plug-in their_shapes/deep/er.py",
    ]
    assert not [name for name in sys.modules if name.startswith("their_")]


def test_a_change_of_a_module_that_is_imported_further_down_is_another_content(beside: Path) -> None:
    before = contents({"memory": None, "plugins": ["their_shapes.arcs"]}, {})
    (beside / "their_numbers.py").write_text("pi = 3\n")
    after = contents({"memory": None, "plugins": ["their_shapes.arcs"]}, {})
    changed = [one.name for one, other in zip(before, after, strict=True) if one.sha256 != other.sha256]
    assert changed == ["plug-in their_numbers.py"]


def test_files_in_lists_and_with_odd_names_count_too(tmp_path: Path) -> None:
    (tmp_path / 'a "b".csv').write_text("1")
    (tmp_path / "c.csv").write_text("2")
    files = [str(tmp_path / 'a "b".csv'), str(tmp_path / "none.csv")]
    found = names({"plugins": [], "scenario": {"tables": files, "parts": [{"table": str(tmp_path / "c.csv")}]}})
    assert found == ["scenario.parts.0.table", "scenario.tables.0"]


def test_a_module_that_cannot_be_parsed_or_found_is_no_traceback(beside: Path) -> None:
    (beside / "their_roads.py").write_text("def (:\n")
    assert names({"plugins": ["their_roads"]}) == ["plug-in their_roads.py"]
    assert names({"plugins": ["their_lost_one"]}) == []
