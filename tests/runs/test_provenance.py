"""Where results come from."""

from importlib import metadata

import pytest

from codriving.runs.provenance import versions
from codriving.version import __version__


def test_version_is_that_of_the_code_and_not_of_what_was_installed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(metadata, "version", lambda name: "0.0.1")
    assert versions()["codriving"] == __version__ != "0.0.1"
