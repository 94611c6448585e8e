"""The printed table for a page or an issue: ``summary.md`` and its like."""

from codriving.reports.display import Display


def markdown_text(table: Display, level: int = 1) -> str:
    """Write a table as Markdown."""
    rules = ["---" if head in table.words else "---:" for head in table.columns]
    lines = [f"{'#' * level} {table.title}", "", _line(table.columns), _line(rules)]
    for line in table.lines:
        lines.append(_line([cell if line.ours or not cell else f"*{cell}*" for cell in map(_escape, line.cells)]))
    lines += ["", *table.notes]
    return "\n".join(lines) + "\n"


def _line(cells: list[str] | tuple[str, ...]) -> str:
    return f"| {' | '.join(cells)} |"


def _escape(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")
