"""A run does not go on once a file that its config names holds something else, and goes on when it is restored."""

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from remembered import experience, filled

import codriving
from codriving.config.sweep import expand
from codriving.errors import RunFolderError
from codriving.experiment.batch import manifest_of
from codriving.experiment.plan import make_plan
from codriving.methods.learned.weights import shipped, sidecar
from codriving.runs.run_folder import RunFolder

PACKAGE = "lent_roads"
MODEL = ("llm=custom", "llm.api_base=http://127.0.0.1:1/v1")
OURS = Path(codriving.__file__).parent
PROMPTS = OURS / "llm" / "prompts"


class Run:
    """A run that is begun, and gone on with, without driving."""

    def __init__(self, path: Path, *tokens: str, config_dir: Path | None = None) -> None:
        self.path, self.tokens, self.config_dir = path / "run", ("launcher=serial", *tokens), config_dir
        self.go_on()

    def go_on(self, *more: str) -> None:
        plan = make_plan(expand([*self.tokens, *more], self.config_dir), self.config_dir)
        with RunFolder(self.path, manifest_of(plan, {}), {cell.folder: "" for cell in plan.cells}):
            pass

    def refused(self, *more: str) -> str:
        with pytest.raises(RunFolderError) as stop:
            self.go_on(*more)
        assert "restore it, or choose another run=<name>" in str(stop.value)
        return str(stop.value)

    def changes(self, path: Path, more: str = "\n") -> str:
        """Edit a file, see the run refused, and restore the file."""
        before = path.read_bytes()
        path.write_bytes(before + more.encode())
        said = self.refused()
        path.write_bytes(before)
        self.go_on()
        return said


def test_a_changed_template_of_the_users(tmp_path: Path) -> None:
    mine = tmp_path / "mine"
    mine.mkdir()
    for name in ("decide.user.md.j2", "dilu.user.md.j2"):
        shutil.copy(PROMPTS / "planner" / name if name.startswith("decide") else PROMPTS / name, mine)
    run = Run(tmp_path, *MODEL, f"prompts={mine}")
    said = run.changes(mine / "decide.user.md.j2")
    assert said.startswith(f"{mine / 'decide.user.md.j2'} (template decide.user.md.j2) has changed since")
    shutil.copy(PROMPTS / "informed" / "negotiate.user.md.j2", mine)
    run.go_on()
    (mine / "dilu.user.md.j2").write_text("Nothing that this method asks.")
    run.go_on()


def test_a_changed_template_of_ours(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ours = tmp_path / "ours"
    shutil.copytree(PROMPTS, ours)
    monkeypatch.setattr("codriving.llm.prompts.render.OURS", ours)
    run = Run(tmp_path, *MODEL)
    assert "(template negotiate.system.md.j2) has changed" in run.changes(ours / "informed" / "negotiate.system.md.j2")


def test_a_changed_cell_is_refused_beside_others_that_have_not_changed(tmp_path: Path) -> None:
    mine = tmp_path / "mine"
    mine.mkdir()
    shutil.copy(PROMPTS / "planner" / "decide.user.md.j2", mine)
    run = Run(tmp_path, "llm.api_base=http://127.0.0.1:1/v1", f"llm.prompts={mine},null", "llm=custom")
    assert "(template decide.user.md.j2) has changed" in run.changes(mine / "decide.user.md.j2")


@pytest.mark.parametrize("part", ["weights", "json"])
def test_changed_weights(tmp_path: Path, part: str) -> None:
    file = tmp_path / "mine.safetensors"
    ours = shipped("ppo", "junction", limited=True)
    shutil.copy(ours, file)
    shutil.copy(sidecar(ours), sidecar(file))
    run = Run(tmp_path, "method=ppo", f"method.weights={file}")
    if part == "json":
        assert f"{sidecar(file)} (weights, purpose) has changed" in run.changes(sidecar(file))
        return
    before = file.read_bytes()
    file.write_bytes(before[:-1] + bytes([before[-1] ^ 1]))
    assert f"{file} (weights) has changed" in run.refused()
    file.write_bytes(before)
    run.go_on()


def test_a_changed_memory_and_another_one(tmp_path: Path) -> None:
    file, other = tmp_path / "a.sqlite", tmp_path / "b.sqlite"
    filled(file, [experience()])
    run = Run(tmp_path, f"memory.file={file}", "memory=frozen")
    copy = tmp_path / "copy.sqlite"
    shutil.copy(file, copy)
    run.tokens = ("launcher=serial", "memory=frozen")
    run.go_on(f"memory.file={copy}")
    filled(other, [experience(step=8)], first=20_007)
    run.go_on(f"memory.file={file},{other}")
    filled(file, [experience(step=9)], first=20_009)
    assert f"{file} (memory) has changed" in run.refused(f"memory.file={file}")


@pytest.fixture
def package(tmp_path: Path) -> Iterator[Path]:
    """A package of the user's beside a config folder, with a road of ours under another name."""
    folder = tmp_path / PACKAGE
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "roads.py").write_text(
        "from codriving.environment.scenarios.intersection import Intersection\n\n\n"
        'class Lent(Intersection):\n    name = "lent"\n'
    )
    scenario = tmp_path / "conf" / "scenario"
    scenario.mkdir(parents=True)
    ours = OURS.parent / "conf" / "scenario" / "intersection.yaml"
    place = "codriving.environment.scenarios.intersection.Intersection"
    lent = ours.read_text().replace(place, f"{PACKAGE}.roads.Lent")
    (scenario / "lent.yaml").write_text(f"{lent}plugins: [{PACKAGE}]\n")
    yield folder
    for name in [name for name in sys.modules if name.startswith(PACKAGE)]:
        del sys.modules[name]
    sys.path[:] = [entry for entry in sys.path if entry != str(tmp_path)]


def test_a_changed_plug_in(tmp_path: Path, package: Path) -> None:
    run = Run(tmp_path, "scenario=lent", config_dir=tmp_path / "conf")
    said = run.changes(package / "roads.py", "# Edited.\n")
    assert f"{PACKAGE}/roads.py" in said
    assert "has changed" in said
    (package / "more.py").write_text("")
    assert "was added" in run.refused()
    (package / "more.py").unlink()
    run.go_on()
    manifest = (run.path / "manifest.json").read_text()
    assert "_target_" not in manifest
    assert '"plugins' not in manifest
