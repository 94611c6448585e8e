"""Files hold one idea each: about 120 lines, never more than 400."""

from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
LONGEST = 400


@pytest.mark.parametrize(
    "path", sorted((REPOSITORY / "codriving").rglob("*.py")), ids=lambda path: str(path.relative_to(REPOSITORY))
)
def test_file_is_short_enough(path: Path) -> None:
    lines = len(path.read_text(encoding="utf-8").splitlines())
    assert lines <= LONGEST, f"{lines} lines: split it into two ideas"
