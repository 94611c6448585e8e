"""The newest release is the same everywhere."""

import re

import yaml
from source import REPOSITORY

from codriving.version import __version__


def test_changelog_citation_and_program_name_one_release() -> None:
    changelog = (REPOSITORY / "CHANGELOG.md").read_text(encoding="utf-8")
    newest = re.search(r"^## \[(\d[\d.]*)\] - (\d{4}-\d\d-\d\d)$", changelog, re.M)
    assert newest
    cited = yaml.safe_load((REPOSITORY / "CITATION.cff").read_text(encoding="utf-8"))
    assert (cited["version"], str(cited["date-released"])) == newest.groups()
    assert ".dev" in __version__ or __version__ == cited["version"]
