"""What is said of the models of a batch, and until when."""

from types import SimpleNamespace
from typing import Any

import pytest

from codriving.config import compose
from codriving.experiment.asking import Asked


def test_of_requests_that_are_under_way_when_a_batch_has_ended_no_more_is_said(
    capsys: pytest.CaptureFixture[str],
) -> None:
    resolved = compose(["llm=custom", "llm.model=openai/toy", "llm.api_base=http://127.0.0.1:9/v1"])
    cell: Any = SimpleNamespace(folder="a", resolved=resolved)
    asked = Asked([cell])
    client: Any = asked.models["a"].chat()
    client.on_retry("busy; attempt 2 of 5")
    client.on_note("no usage")
    assert capsys.readouterr().err == "busy; attempt 2 of 5\nno usage\n"
    asked.fall_silent()
    client.on_retry("busy; attempt 3 of 5")
    client.on_note("no usage")
    assert capsys.readouterr().err == ""
    assert asked.retries == 1
