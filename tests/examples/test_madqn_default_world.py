"""The example of MADQN for the world of this release: the configs are those by which its weights were trained."""

from pathlib import Path

import pytest

from codriving.config.training import compose_training
from codriving.methods.learned.weights import load
from codriving.training.folder import fingerprint

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "madqn_default_world"


@pytest.mark.parametrize("family", ["junction", "lanes"])
def test_weights_are_those_of_the_config_beside_them(family: str) -> None:
    name = f"madqn_{family}"
    purpose = load(FOLDER / f"{name}.safetensors").purpose
    assert (purpose.method, purpose.family, purpose.world) == ("madqn", family, {"limits": "road", "drivers": "mixed"})
    assert (
        fingerprint(compose_training(name, (), smoke=False, config_dir=FOLDER / "conf")) == purpose.training["config"]
    )
