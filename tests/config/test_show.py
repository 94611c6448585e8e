"""A config as text that composes to the same."""

import yaml

from codriving.config.compose import compose
from codriving.config.show import show


def test_shown_config_reads_back_the_same() -> None:
    resolved = compose(["run=2026_01", "cda=prescriptive"])
    assert yaml.safe_load(show(resolved)) == resolved
