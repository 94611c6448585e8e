"""Run tests in forked processes that have everything imported but the program itself."""

import importlib
import importlib.abc
import importlib.machinery
import importlib.util
import json
import math
import os
import resource
import signal
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

from tests.mutants.changes import Change, changed

SLACK = 20.0
"""Processor time that a mutant may take beyond three times that of its tests without the change [s]."""

BROKEN = 70
"""Exit code of a process that could not try a change."""


@dataclass
class Reach:
    """Which tests run through which line.

    Attributes:
        lines: Test ids by file and line.
        seconds: Time of each test that passes [s].
        modules: What else the tests import.
    """

    lines: dict[str, dict[int, set[str]]] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    modules: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Outcome:
    """Whether a change was noticed, and by which test."""

    noticed: bool
    by: str


def reach(root: Path, rooms: Sequence[str], tests: Sequence[str]) -> Reach:
    """Run all tests once without a change, and keep which lines each of them runs through."""
    with tempfile.TemporaryDirectory() as folder:
        found = Path(folder) / "reach.json"
        child = os.fork()
        if child == 0:
            _in_child(root, Path(folder) / "output", lambda: _trace(root, rooms, tests, found))
        os.waitpid(child, 0)
        if not found.exists():
            raise SystemExit((Path(folder) / "output").read_text(errors="replace")[-3000:])
        raw = json.loads(found.read_text())
        if not raw["seconds"]:
            raise SystemExit(f"no test passes: {(Path(folder) / 'output').read_text(errors='replace')[-3000:]}")
    lines = {file: {int(line): set(ids) for line, ids in at.items()} for file, at in raw["lines"].items()}
    return Reach(lines, raw["seconds"], raw["modules"])


def run(root: Path, drawn: Sequence[Change], reached: Reach, workers: int) -> Iterator[tuple[Change, Outcome]]:
    """Try each change in a process of its own, several at a time."""
    sys.path.insert(0, str(root))
    for name in reached.modules:
        try:
            importlib.import_module(name)
        except Exception:  # a module that cannot be imported alone is imported by the tests
            continue
    # Read once, so that what is edited meanwhile is not mixed up with what was drawn.
    sources = {change.file: (root / change.file).read_text(encoding="utf-8") for change in drawn}
    waiting, busy = list(reversed(drawn)), dict[int, tuple[Change, float, Path]]()
    with tempfile.TemporaryDirectory() as folder:
        while waiting or busy:
            while waiting and len(busy) < workers:
                change = waiting.pop()
                tests = chosen(reached, change, root)
                if not tests:
                    yield change, Outcome(False, "no test runs through it")
                    continue
                limit = SLACK + 3 * sum(reached.seconds[t] for t in tests)
                output = Path(folder) / str(len(waiting))
                child = os.fork()
                if child == 0:
                    _in_child(root, output, lambda c=change, t=tests, s=limit: _try(root, c, sources[c.file], t, s))
                busy[child] = change, time.monotonic() + 4 * limit, output
            ended, status = os.waitpid(-1, os.WNOHANG)
            if ended in busy:
                change, _, output = busy.pop(ended)
                yield change, _outcome(status, output)
                continue
            for child, (_, until, _) in busy.items():
                if time.monotonic() > until:
                    os.kill(child, signal.SIGKILL)
            time.sleep(0.02)


def chosen(reached: Reach, change: Change, root: Path) -> list[str]:
    """Return the tests that run through a change, the likeliest and quickest first.

    What stands outside functions runs on import: there, every test counts that runs through the file, or through one
    that imports it.
    """
    at = reached.lines.get(change.file, {})
    inside = (change.where and change.where.split(".")[-1][:1].islower()) or change.where.split(".")[-1].startswith("_")
    ids = set[str]()
    if inside:
        for line in range(change.line, change.end + 1):
            ids |= at.get(line, set())
    else:
        module = change.file.removesuffix(".py").replace("/", ".")
        for file, lines in reached.lines.items():
            if file == change.file or module in (root / file).read_text(encoding="utf-8"):
                ids |= set().union(*lines.values())
    own, room = f"test_{Path(change.file).stem}.py", f"/{Path(change.file).parent.name}/"
    first: dict[str, float] = {}
    for i in ids:
        first[_file(i)] = min(first.get(_file(i), math.inf), reached.seconds[i])
    rank = {file: (own not in file, room not in file, seconds, file) for file, seconds in first.items()}
    return sorted(ids, key=lambda i: (rank[_file(i)], reached.seconds[i]))


def _file(test: str) -> str:
    return test.split("::")[0]


def _outcome(status: int, output: Path) -> Outcome:
    if os.WIFSIGNALED(status):
        return Outcome(True, f"signal {os.WTERMSIG(status)}")
    code = os.WEXITSTATUS(status)
    if code == BROKEN:
        raise SystemExit(f"the change could not be tried: {output.read_text(errors='replace')[-2000:]}")
    said = [line for line in output.read_text(errors="replace").splitlines() if line.startswith(("FAILED", "ERROR"))]
    return Outcome(code != 0, said[0] if said else f"exit code {code}")


def _in_child(root: Path, output: Path, work: Any) -> None:
    code = BROKEN
    try:
        os.chdir(root)
        with output.open("w") as file:
            os.dup2(file.fileno(), 1)
            os.dup2(file.fileno(), 2)
        code = work()
        sys.stdout.flush()
    except BaseException as error:
        print(f"ERROR {type(error).__name__}: {error}", flush=True)
    finally:
        os._exit(code)


def _try(root: Path, change: Change, source: str, tests: list[str], limit: float) -> int:
    used = resource.getrusage(resource.RUSAGE_SELF)
    soft = int(used.ru_utime + used.ru_stime + limit) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (soft, soft + 5))
    path = root / change.file
    code = compile(changed(source, change, path), path, "exec")
    sys.meta_path.insert(0, _Mutant(change.file.removesuffix(".py").replace("/", "."), path, code))
    return _pytest(["-x", *tests], [])


class _Mutant(importlib.machinery.SourceFileLoader, importlib.abc.MetaPathFinder):
    """Finds and loads one module with its changed code."""

    def __init__(self, name: str, path: Path, code: CodeType) -> None:
        super().__init__(name, str(path))
        self.code = code

    def find_spec(self, name: str, path: Any = None, target: ModuleType | None = None) -> Any:
        """Find the one module."""
        if name == self.name or name == self.name.removesuffix(".__init__"):
            return importlib.util.spec_from_file_location(name, self.path, loader=self)
        return None

    def get_code(self, fullname: str) -> CodeType:
        """Return the changed code."""
        return self.code


QUIET = (
    *("-q", "--tb=no", "-ra", "-o", "addopts=", "--import-mode=importlib"),
    *("-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:pytest_cov"),
    *("-W", "ignore::pytest.PytestAssertRewriteWarning"),
)


def _pytest(arguments: list[str], plugins: list[Any]) -> int:
    import pytest
    from hypothesis import Phase, settings

    phases = (Phase.explicit, Phase.generate)
    settings.register_profile("mutants", derandomize=True, deadline=None, database=None, phases=phases)
    settings.load_profile("mutants")
    return int(pytest.main([*QUIET, *arguments], plugins))


def _trace(root: Path, rooms: Sequence[str], tests: Sequence[str], into: Path) -> int:
    import coverage

    before = set(sys.modules)
    include = [str(root / room / "*") if (root / room).is_dir() else str(root / room) for room in rooms]
    watch = coverage.Coverage(data_file=None, config_file=False, include=include)
    tracer = _Tracer(watch)
    watch.start()
    _pytest([*tests, "--continue-on-collection-errors"], [tracer])
    watch.stop()
    data, lines = watch.get_data(), dict[str, dict[int, set[str]]]()
    users = tracer.users()
    for file in data.measured_files():
        at = lines.setdefault(str(Path(file).relative_to(root)), {})
        for line, contexts in data.contexts_by_lineno(file).items():
            ids = {i for c in contexts for i in users.get(c, [c]) if i in tracer.seconds}
            if ids:
                at[line] = ids
    ours = {"codriving", "tests", *(p.stem for p in (root / "tests").rglob("*.py"))}
    new = sorted(name for name in set(sys.modules) - before if name.split(".")[0] not in ours)
    modules = [name for name in new if getattr(sys.modules[name], "__spec__", None)]
    raw = {f: {str(n): sorted(ids) for n, ids in at.items()} for f, at in lines.items()}
    into.write_text(json.dumps({"lines": raw, "seconds": tracer.seconds, "modules": modules}))
    return 0


class _Tracer:
    """A plug-in of pytest that keeps apart what each test and each shared fixture runs through."""

    def __init__(self, watch: Any) -> None:
        self.watch, self.seconds, self.fixtures = watch, dict[str, float](), dict[str, set[str]]()
        self.failed, self.now = set[str](), ""

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """Lines from here on belong to this test."""
        self.now = nodeid
        self.watch.switch_context(nodeid)

    def pytest_collection_modifyitems(self, items: list[Any]) -> None:
        """Keep which tests use which fixture."""
        for item in items:
            for name in item.fixturenames:
                self.fixtures.setdefault(name, set()).add(item.nodeid)

    def pytest_fixture_setup(self, fixturedef: Any) -> None:
        """Lines from here on belong to a fixture, if several tests share it."""
        if fixturedef.scope != "function":
            self.watch.switch_context(f"fixture {fixturedef.argname}")

    def pytest_fixture_post_finalizer(self) -> None:
        """Nothing to keep."""

    def pytest_runtest_call(self) -> None:
        """The fixtures are there."""
        self.watch.switch_context(self.now)

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Keep the time of what passes."""
        if report.failed:
            self.failed.add(report.nodeid)
            self.seconds.pop(report.nodeid, None)
        elif report.when == "call" and report.passed and report.nodeid not in self.failed:
            self.seconds[report.nodeid] = report.duration

    def users(self) -> dict[str, list[str]]:
        """Return the tests of each fixture."""
        return {f"fixture {name}": sorted(ids) for name, ids in self.fixtures.items()}
