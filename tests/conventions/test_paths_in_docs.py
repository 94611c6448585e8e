"""The pages name files and folders of the repository that are there."""

import re

from source import PACKAGE, REPOSITORY

PAGES = [*REPOSITORY.glob("*.md"), *(REPOSITORY / "docs").rglob("*.md")]
ROOMS = "|".join(path.name for path in PACKAGE.iterdir() if path.is_dir())


def test_named_files_are_there() -> None:
    missing = []
    for page in PAGES:
        if page.name == "CHANGELOG.md":
            continue
        text = page.read_text(encoding="utf-8")
        named = [(REPOSITORY, path) for path in re.findall(r"`((?:codriving|tests)/[a-z0-9_/]+(?:\.py)?)`", text)]
        named += [(PACKAGE, path) for path in re.findall(rf"`((?:{ROOMS})/[a-z0-9_/]+\.py)`", text)]
        missing += [f"{page.name}: {path}" for root, path in named if not (root / path).exists()]
    assert not missing
