"""Methods as objects: what a run with one is, that it is driven as one with a YAML, and where it cannot be."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from own_methods import Farthest, Same, Steady, Told

import codriving
from codriving.errors import ConfigError, RunFolderError

SHORT = ("episodes=1", "seed=20000", "scenario.time_limit=4", "scenario.cavs=2")
HERE = Path(__file__).parent

LOCAL = """
from own_methods import Steady
class Local(Steady):
    name = "local"
"""


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def notebook_class() -> type[Steady]:
    """A class as one of a notebook is."""
    space = {"__name__": "__main__"}
    exec(LOCAL, space)
    return space["Local"]  # type: ignore[return-value]


def test_objects_classes_and_names_are_rows_of_one_run() -> None:
    given = [Steady(), Steady("FASTER"), Told, Farthest(), "fcfs"]
    result = codriving.run(*SHORT, "launcher=serial", "run=x", method=given)
    assert list(result.summary["method"]) == ["steady", "steady", "told", "farthest", "fcfs"]
    assert list(result.summary["variant"])[:2] == ["", "faster"]
    assert list(result.summary["reasoner"]) == ["none", "none", "rules", "none", "none"]
    actions = {row: set(result.trajectories(cell=row).query("kind == 'CAV'")["action"]) for row in ("steady-faster",)}
    assert actions["steady-faster"] <= {"FASTER", ""}
    chosen = [cell.choices["method"] for cell in result.manifest.cells]
    assert [name.partition("@")[0] for name in chosen] == ["Steady", "Steady", "Told", "Farthest", "fcfs"]
    assert len(set(chosen)) == 5


def test_an_object_drives_as_its_class_by_a_yaml_does_also_in_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    (folder := Path("conf/method")).mkdir(parents=True)
    (folder / "steady.yaml").write_text("# Does the same.\n_target_: own_methods.Steady\nplugins: [own_methods]\n")
    named = codriving.run(*SHORT, "launcher=serial", "run=named", "method=steady", config_dir="conf")
    here = codriving.run(*SHORT, "launcher=serial", "run=here", method=Steady())
    there = codriving.run(*SHORT, "episodes=2", "workers=2", "run=there", method=Steady())
    files = [
        (result.folder / "episodes" / "intersection-steady" / "20000" / name).read_bytes()
        for result in (named, here, there)
        for name in ("record.json", "trajectory.csv")
    ]
    assert files[0::2] == [files[0]] * 3
    assert files[1::2] == [files[1]] * 3


def test_a_run_goes_on_with_an_object_that_does_the_same_and_with_no_other() -> None:
    asked = (*SHORT, "launcher=serial", "run=x")
    codriving.run(*asked, method=Steady())
    codriving.run(*asked, method=Steady("SLOWER"))
    with pytest.raises(RunFolderError, match=r"method was Steady@\w{12}, is now Steady@\w{12}"):
        codriving.run(*asked, method=Steady("FASTER"))


def test_a_class_of_a_notebook_is_driven_in_this_process_and_refuses_workers() -> None:
    local = notebook_class()
    result = codriving.run(*SHORT, "run=x", method=local)
    assert list(result.episodes["method"]) == ["local"]
    again = codriving.run(*SHORT, "run=x", method=notebook_class())
    assert again.folder == result.folder
    for token in ("workers=4", "launcher=processes"):
        with pytest.raises(ConfigError) as caught:
            codriving.run(*SHORT, token, method=local)
        assert str(caught.value) == (
            f"the class Local is of a notebook or script, so no worker process can make it; leave {token} out, or put "
            "the class into a module"
        )


def test_beside_the_methods_of_a_comparison() -> None:
    result = codriving.compare(
        *("baselines", *SHORT, "controls=false", "scenario.time_limit=1", "launcher=serial", "run=x"),
        method=[Steady(), "noncoop_game"],
    )
    table = result.table.set_index("method")
    assert {"steady", "codriving", "fcfs", "noncoop_game"} <= set(table.index)
    assert table.loc["steady", "pairs"] == 1


@pytest.mark.parametrize(
    ("method", "tokens", "said"),
    [
        (
            5,
            (),
            "a method is a name, or an object or a class that inherits from codriving.datatypes.Method or from codr",
        ),
        (
            Same,
            (),
            "a method is a name, or an object or a class that inherits from codriving.datatypes.Method or from c",
        ),
        ([], (), "method is an empty list; name a method, or leave it out"),
        (
            Steady(),
            ("method=fcfs",),
            "method is given as a text and as an argument; give all of them in one list, metho",
        ),
        (
            Steady(),
            ("method.action=x",),
            "method.action=x does not reach an object; give it the value where it is made",
        ),
        ("nomethod", (), "unknown method 'nomethod'; choices: "),
        (Farthest, ("scenario.cavs=99",), "scenario.cavs must be "),
        (type("Odd", (Steady,), {"name": 3}), (), "method: Odd needs an attribute 'name' of type str for the tables"),
        (type("Odd", (Steady,), {"reasoner": 3}), (), "method: the attribute 'reasoner' of Odd must be of type str"),
    ],
)
def test_what_is_no_method_is_refused_in_a_line(method: object, tokens: tuple[str, ...], said: str) -> None:
    with pytest.raises(ConfigError) as caught:
        codriving.run(*SHORT, *tokens, method=method)
    assert str(caught.value).startswith(said)


def test_where_only_names_are_taken_that_is_said() -> None:
    with pytest.raises(ConfigError, match=r"^compare orders takes methods by their names alone, and objects stand in"):
        codriving.compare("orders", method=Steady())


def test_a_class_that_lacks_what_every_method_has_is_refused() -> None:
    half = type("Half", (Steady,), {"act": None})
    half.__abstractmethods__ = frozenset({"act"})
    with pytest.raises(ConfigError, match=r"^Half lacks act; every method has to have it$"):
        codriving.run(method=half)
