"""The pages name files and folders of the repository that are there."""

import re
from pathlib import Path

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


def test_each_name_of_a_run_belongs_to_one_page() -> None:
    """The pages can be followed one after the other: no command meets a run folder of another config."""
    pages: dict[tuple[str, str], set[str]] = {}
    for page in PAGES:
        for command, name in re.findall(r"^    codriving (\w+).*? run=(\w+)", page.read_text(encoding="utf-8"), re.M):
            pages.setdefault((command, name), set()).add(page.name)
    # The README shows the commands of two pages.
    shown = {("run", "first"): "getting-started.md", ("memory", "learnt"): "memory.md"}
    assert {key: names - {"README.md"} for key, names in pages.items() if key in shown} == {
        key: {name} for key, name in shown.items()
    }
    assert not {key: names for key, names in pages.items() if key not in shown and len(names) > 1}


def test_nothing_is_said_to_be_on_a_package_index() -> None:
    told = [page.name for page in PAGES if re.search(r"pip install ['\"]?codriving", page.read_text(encoding="utf-8"))]
    assert not told


def _anchors(page: Path) -> set[str]:
    """The names by which the headings of a page are linked to."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_links_lead_to_pages_and_headings_that_are_there() -> None:
    broken = []
    for page in PAGES:
        for link in re.findall(r"\]\((?!https?:)([^)\s]+)\)", page.read_text(encoding="utf-8")):
            path, _, anchor = link.partition("#")
            target = (page.parent / path) if path else page
            if not target.exists() or (anchor and anchor not in _anchors(target)):
                broken.append(f"{page.name}: {link}")
    assert not broken
