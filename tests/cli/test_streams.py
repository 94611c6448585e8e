"""Streams that are closed or full: what was asked for is done all the same, and nothing is a traceback."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from thorough import some

from codriving.cli.faults import one_line

REPOSITORY = Path(__file__).resolve().parents[2]


def shell(line: str, folder: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    command = f"{sys.executable} -m codriving"
    path = os.pathsep.join(filter(None, [str(REPOSITORY), os.environ.get("PYTHONPATH")]))
    # LiteLLM sets variables of its own where another test has imported it.
    ours = {name: value for name, value in os.environ.items() if not name.startswith("LITELLM_")}
    return subprocess.run(
        ["/bin/sh", "-c", line.replace("codriving", command)],
        cwd=folder,
        env={**ours, "PYTHONPATH": path, **variables},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


@pytest.mark.parametrize("closed", some(2, ["2>&-", "<&- >&- 2>&-", ">&-", "<&-"]))
def test_with_a_closed_stream_episodes_are_driven(closed: str, tmp_path: Path) -> None:
    result = shell(f"codriving run run=a episodes=1 scenario.time_limit=1 launcher=serial {closed}", tmp_path)
    assert result.returncode == 0
    assert "Traceback" not in result.stderr
    assert len(list(tmp_path.glob("outputs/run/a/episodes/*/0/record.json"))) == 1


def test_a_full_output_is_one_line_and_a_full_error_stream_is_nothing(tmp_path: Path) -> None:
    result = shell("codriving list >/dev/full", tmp_path)
    assert result.returncode == 2
    assert result.stderr.startswith("error: cannot write to standard output (No space left on device); ")
    assert result.stderr.count("\n") == 1
    result = shell("codriving list 2>/dev/full", tmp_path)
    assert (result.returncode, result.stdout.split()[0]) == (0, "scenarios")
    assert shell("codriving list nothing 2>/dev/full", tmp_path).returncode == 2


def test_a_reader_that_goes_away_is_told_nothing(tmp_path: Path) -> None:
    result = shell("{ codriving run --cfg; echo $? >code; } | head -1", tmp_path)
    assert (len(result.stdout.splitlines()), result.stderr) == (1, "")
    assert (tmp_path / "code").read_text() in ("141\n", "0\n")  # 0 if it was quicker than head


def test_a_narrow_encoding_shows_what_it_can(tmp_path: Path) -> None:
    result = shell("""codriving run --cfg 'output="übung"'""", tmp_path, PYTHONIOENCODING="ascii")
    assert "output: \\xfcbung\n" in result.stdout
    assert (result.returncode, result.stderr) == (0, "")


@pytest.mark.parametrize("value", some(1, ["module://nothing.here", "nothing"]))
def test_drawing_ignores_the_backend_of_a_notebook(value: str, tmp_path: Path) -> None:
    result = shell("codriving run --cfg", tmp_path, MPLBACKEND=value)
    assert (result.returncode, result.stderr) == (0, "")


def test_warnings_as_errors_of_other_programs_stop_nothing(tmp_path: Path) -> None:
    result = shell("codriving run --cfg && codriving check llm=offline", tmp_path, PYTHONWARNINGS="error")
    assert (result.returncode, result.stderr) == (0, "")


def test_a_shell_that_asks_nonsense_after_tab_is_told_nothing(tmp_path: Path) -> None:
    asked = {"_CODRIVING_COMPLETE": "complete_bash", "COMP_WORDS": "codriving run sc", "COMP_CWORD": "²"}
    result = shell("codriving", tmp_path, **asked)
    assert (result.returncode, result.stdout, result.stderr) == (1, "", "")


@pytest.mark.parametrize(
    ("name", "value", "said"),
    some(
        1,
        [
            (
                "LITELLM_LOG",
                "nothing",
                "AttributeError: module 'logging' has no attribute 'NOTHING'); unset LITELLM_LOG",
            ),
            (
                "DEFAULT_MAX_RETRIES",
                "many",
                "ValueError: invalid literal for int() with base 10: 'many'); unset DEFAULT_MAX_",
            ),
            ("SSL_CERT_FILE", "/", "IsADirectoryError: [Errno 21] Is a directory); unset SSL_CERT_FILE"),
        ],
    ),
)
def test_a_variable_that_stops_an_import_is_named(name: str, value: str, said: str, tmp_path: Path) -> None:
    check = "codriving check llm=custom llm.api_base=http://127.0.0.1:9/v1"
    result = shell(check, tmp_path, **{name: value})
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr.startswith(f"error: LiteLLM, which asks language models, cannot be imported ({said}")
    assert result.stderr.count("\n") == 1


def test_a_temporary_folder_of_too_long_a_path_is_named(tmp_path: Path) -> None:
    folder = tmp_path / ("x" * 120)
    folder.mkdir()
    result = shell("codriving run episodes=2 workers=2 scenario.time_limit=1", tmp_path, TMPDIR=str(folder))
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr == (
        f"error: cannot start worker processes in the folder for temporary files {folder} (AF_UNIX path too long); "
        "set TMPDIR to another folder with a short path, or launcher=serial\n"
    )


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (OSError(36, "File name too long", "/x/y"), "/x/y: File name too long; give it a shorter name, or take a fold"),
        (OSError(28, "No space left on device", "/x"), "/x: No space left on device; make room, or name a place on"),
        (PermissionError(13, "Permission denied", b"/x"), "/x: Permission denied; change its permissions, or name an"),
    ],
)
def test_what_the_file_system_refuses_has_a_cure(error: OSError, said: str) -> None:
    assert one_line(error, []).startswith(said)


def test_a_fault_of_a_plugin_names_its_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    plugin = tmp_path / "mine.py"
    plugin.write_text("def work():\n    return 1 / 0\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    import mine  # type: ignore[import-not-found]

    with pytest.raises(ZeroDivisionError) as caught:
        mine.work()
    said = one_line(caught.value.with_traceback(caught.tb.tb_next), [])
    (file,) = tmp_path.glob("codriving-fault-*.txt")
    assert said == (
        f"the plug-in {plugin}:2 failed (ZeroDivisionError: division by zero); its traceback is in {file}: "
        "mend the plug-in"
    )
    assert "ZeroDivisionError" in file.read_text()


def test_a_fault_quotes_no_secret_of_the_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setenv("THEIR_TOKEN", "hunter2-and-more")
    said = one_line(RuntimeError("server refused hunter2-and-more"), [])
    (file,) = tmp_path.glob("codriving-fault-*.txt")
    assert "(RuntimeError: server refused <redacted>)" in said
    assert "hunter2" not in said + file.read_text()
