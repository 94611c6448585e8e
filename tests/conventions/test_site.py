"""The site of the pages: each has its place in the reading order, and nothing is asked of the network."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).resolve().parents[2]
SITE = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))


def _pages(nav: Any) -> Iterator[str]:
    if isinstance(nav, str):
        yield nav
    for item in nav if isinstance(nav, list) else nav.values() if isinstance(nav, dict) else ():
        yield from _pages(item)


def test_every_page_stands_once_in_the_reading_order() -> None:
    named = [page for page in _pages(SITE["nav"]) if not page.startswith("repository/")]
    docs = ROOT / "docs"
    assert sorted(named) == sorted(page.relative_to(docs).as_posix() for page in docs.rglob("*.md"))


def test_what_stands_beside_the_pages_is_in_the_repository() -> None:
    beside = [page.removeprefix("repository/") for page in _pages(SITE["nav"]) if page.startswith("repository/")]
    assert [page for page in beside if not (ROOT / page).is_file()] == []
    assert "README.md" in beside


def test_reading_order_has_four_parts() -> None:
    assert [name for part in SITE["nav"] for name in part] == ["Start", "Understand", "Do", "Look up"]


def test_nothing_is_asked_of_the_network() -> None:
    assert SITE["theme"]["font"] is False
    assert SITE["plugins"] == ["search"]
    assert "extra_javascript" not in SITE
    assert [style for style in SITE["extra_css"] if not (ROOT / "docs" / style).is_file()] == []
    # The theme fetches the program that draws them.
    assert not [page.name for page in (ROOT / "docs").rglob("*.md") if "```mermaid" in page.read_text(encoding="utf-8")]


def test_a_link_that_leads_nowhere_is_an_error() -> None:
    assert SITE["strict"] is True
    assert SITE["validation"]["anchors"] == "warn"
