"""The bar of a batch in a notebook, without a notebook: what is displayed is noted."""

import sys
from types import SimpleNamespace

import pytest

from codriving.experiment import notebook
from codriving.experiment.progress import show_progress


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What a notebook displays, one after the other."""
    seen: list[str] = []

    def display(page: str, display_id: bool) -> SimpleNamespace:
        assert display_id
        seen.append(page)
        return SimpleNamespace(update=seen.append)

    shell = SimpleNamespace(kernel=object())
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))
    monkeypatch.setitem(sys.modules, "IPython.display", SimpleNamespace(display=display, HTML=str))
    return seen


def test_the_bar_moves_and_ends_as_it_always_does(shown: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(notebook, "EVERY", 0.0)
    with show_progress({"a": 1, "b": 1}, lambda: "5 < 6 tokens") as update:
        update("a", False)
        update("b", True)
    assert shown[0] == (
        '<progress value="0" max="2"></progress> 0 of 2 episodes done, 0 failed, 0 of 2 cells complete; 5 &lt; 6 tokens'
    )
    assert shown[1].startswith('<progress value="1" max="2"></progress> 1 of 2 episodes done, 0 failed, ')
    assert shown[1].endswith(" s left")
    assert shown[-1].startswith('<progress value="2" max="2"></progress> 2 of 2 episodes done, 1 failed, ')
    assert "left" not in shown[-1]


def test_not_every_episode_is_a_message_to_the_browser(shown: list[str]) -> None:
    with show_progress({"a": 1000}) as update:
        for _ in range(1000):
            update("a", False)
    assert len(shown) < 20
    assert shown[-1].startswith('<progress value="1000" max="1000">')


def test_of_nothing_there_is_no_bar(shown: list[str]) -> None:
    with show_progress({}):
        pass
    assert shown == []


def test_a_terminal_is_no_notebook(monkeypatch: pytest.MonkeyPatch) -> None:
    assert notebook.notebook() is None
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: None))
    assert notebook.notebook() is None
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: SimpleNamespace(kernel=None)))
    assert notebook.notebook() is None
