"""The bounds of a comparison: which setting has none is said."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

from codriving.commands.above import BoundsOfRun
from codriving.config import compose


def test_setting_without_bound_is_named(tmp_path: Path) -> None:
    bounds = BoundsOfRun(tmp_path)
    results = SimpleNamespace(
        swept={"suite": "blocked_exit", "method_choice": "fcfs"}, records=[SimpleNamespace(seed=12000)]
    )
    block: Any = [(SimpleNamespace(resolved=compose(["suite=blocked_exit", f"output={tmp_path}"])), results)]
    assert bounds.over([], block) == []
    (note,) = bounds.notes
    assert note.startswith("Above bound is empty at suite=blocked_exit: no bound is defined at a blocked exit")
