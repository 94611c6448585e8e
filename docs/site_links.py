"""Hooks of MkDocs: what pages link to outside ``docs/`` is part of the site, and headings are called as on GitHub.

Pages are written to be read in the repository, too, so their links name files of it.
"""

import posixpath
import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files, InclusionLevel
from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parents[1]
INSIDE, OUTSIDE = (
    "docs/",
    "repository/",
)  # Where the pages are in the repository, and where the rest of it is on the site
LINK = re.compile(r"\]\((?!https?:|mailto:|#)([^)\s#]+)")


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Let headings be called as on GitHub, which is how links name them."""
    config.mdx_configs["toc"] = {"permalink": True, "slugify": anchor}
    return config


def anchor(heading: str, separator: str) -> str:
    """Give the name by which a heading is linked to."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", separator)


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add every file of the repository that a page of the site links to."""
    waiting = [file for file in files if file.is_documentation_page()]
    while waiting:
        page = waiting.pop()
        for link in LINK.findall(page.content_string):
            uri = in_site(target(page, link))
            source = ROOT / target(page, link)
            if files.get_file_from_path(uri) is None and source.is_file():
                added = File.generated(config, uri, abs_src_path=str(source), inclusion=InclusionLevel.NOT_IN_NAV)
                files.append(added)
                waiting += [added] if added.is_documentation_page() else []
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Let links lead to where the site has a file."""
    folder = posixpath.dirname(page.file.src_uri)

    def moved(link: re.Match[str]) -> str:
        uri = in_site(target(page.file, link[1]))
        there = files.get_file_from_path(uri) is not None
        return f"]({posixpath.relpath(uri, folder or '.')}" if there else link[0]

    return LINK.sub(moved, markdown)


def target(page: File, link: str) -> str:
    """Give the path in the repository of what a page links to."""
    uri = page.src_uri
    path = uri.removeprefix(OUTSIDE) if uri.startswith(OUTSIDE) else INSIDE + uri
    return posixpath.normpath(posixpath.join(posixpath.dirname(path), link))


def in_site(path: str) -> str:
    """Give the place on the site of a file of the repository."""
    return path.removeprefix(INSIDE) if path.startswith(INSIDE) else OUTSIDE + path
