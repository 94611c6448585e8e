"""What a YAML of the user's needs: it says so itself, and what stands beside the config folder is found."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.config.plugins import find_beside, gathered
from codriving.errors import ConfigError

PACKAGE = "roads_of_a_user"

YAML = """# A scenario of a user.
_target_: {package}.streets.Street
plugins: [{package}]
width: 4.0
"""


SOURCE = """
class Street:
    def __init__(self, width: float) -> None:
        pass
"""


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of a user's with a package and configs, which is on no search path."""
    monkeypatch.setattr(sys, "path", [*sys.path])
    folder = tmp_path / "a project"
    (folder / PACKAGE).mkdir(parents=True)
    (folder / PACKAGE / "__init__.py").write_text("")
    (folder / PACKAGE / "streets.py").write_text(
        "class Street:\n    def __init__(self, width: float) -> None:\n        pass"
    )
    (folder / "conf" / "scenario").mkdir(parents=True)
    (folder / "conf" / "scenario" / "street.yaml").write_text(YAML.format(package=PACKAGE))
    yield folder
    for name in [name for name in sys.modules if name.startswith(PACKAGE)]:
        del sys.modules[name]


def test_a_yaml_says_itself_what_it_needs_and_finds_it_beside_its_folder(project: Path) -> None:
    config = compose(["scenario=street"], project / "conf")
    assert config["plugins"] == [PACKAGE]
    assert config["scenario"] == {"_target_": f"{PACKAGE}.streets.Street", "width": 4.0}
    assert config["environment"]["scenario"] == config["scenario"]
    assert type(build(config["scenario"], object, "scenario", config["plugins"])).__name__ == "Street"


def test_lists_of_all_files_count_together_each_name_once() -> None:
    root = {"plugins": ["a"], "scenario": {"_target_": "b.B", "plugins": ["b", "a"]}, "method": {"_target_": "x"}}
    nested = {"environment": {"_target_": "y", "parts": [{"_target_": "c.C", "plugins": ["c"]}]}}
    assert gathered({**root, **nested}) == {
        "plugins": ["a", "b", "c"],
        "scenario": {"_target_": "b.B"},
        "method": {"_target_": "x"},
        "environment": {"_target_": "y", "parts": [{"_target_": "c.C"}]},
    }


def test_a_config_without_packages_stays_as_it_is() -> None:
    config = compose([])
    assert gathered(config) == config
    assert config["plugins"] == []


@pytest.mark.parametrize("listed", ["my_roads", ["my roads"], [3], {"a": 1}])
def test_what_is_no_list_of_names_is_refused(listed: object) -> None:
    with pytest.raises(ConfigError, match=r"^scenario\.plugins must be a list of package names, .* got"):
        gathered({"plugins": [], "scenario": {"_target_": "a.B", "plugins": listed}})


def test_other_scenarios_are_not_touched_by_a_package(project: Path) -> None:
    assert compose(["scenario=intersection"], project / "conf")["plugins"] == []
    assert str(project) not in sys.path


def test_the_folder_comes_last_and_once(project: Path) -> None:
    before = [*sys.path]
    find_beside([PACKAGE], project / "conf")
    find_beside([PACKAGE], project / "conf")
    assert sys.path == [*before, str(project)]


def test_the_folder_is_left_alone_if_the_package_is_elsewhere_or_not_there(project: Path) -> None:
    (project / "json.py").write_text("")
    (project / "tomllib.py").write_text("")
    before = [*sys.path]
    find_beside(["json", "tomllib", "not_there"], project / "conf")
    find_beside([PACKAGE], None)
    assert sys.path == before


def test_a_package_that_is_nowhere_is_named_with_the_cure(project: Path) -> None:
    (project / "conf" / "scenario" / "lost.yaml").write_text(YAML.format(package="lost_roads"))
    config = compose(["scenario=lost"], project / "conf")
    with pytest.raises(ConfigError, match="there is no module lost_roads; install it, or put it beside the folder"):
        build(config["scenario"], object, "scenario", config["plugins"])
