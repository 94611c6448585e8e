"""What was written for release 0.1 is told in one line where the names that it uses are now."""

from pathlib import Path

import pytest

from codriving.config.build import build
from codriving.config.moved import new_place
from codriving.errors import ConfigError

RULE = '''"""A rule as it was written for release 0.1."""
from codriving.scenarios.protocol import Scenario
from codriving.ordering.protocol import (
    JointPlanner,
    OrderRule,
)


class MyRule:
    pass
'''


def refused(target: str, *plugins: str) -> str:
    with pytest.raises(ConfigError) as err:
        build({"_target_": target}, object, "method", plugins)
    assert "\n" not in str(err.value)
    return str(err.value)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("codriving.scenarios.intersection.Intersection", "codriving.environment.scenarios.intersection.Intersection"),
        ("codriving.ordering.fcfs.FirstComeFirstServed", "codriving.methods.fcfs.FirstComeFirstServed"),
        ("codriving.llm.offline.Offline", "codriving.llm.language_model.Offline"),
    ],
)
def test_a_yaml_is_told_the_new_place_of_its_class(old: str, new: str) -> None:
    assert refused(old) == f"method._target_ is {old}, which is {new} since release 0.2; write that"


def test_a_plugin_is_told_the_new_place_of_what_it_imports(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "rules_of_a_user.py").write_text(RULE)
    monkeypatch.syspath_prepend(str(tmp_path))
    said = refused("rules_of_a_user.MyRule", "rules_of_a_user")
    assert said.endswith(
        "rules_of_a_user.py imports from codriving.scenarios.protocol, which is not where it was in release 0.1: "
        "Scenario (codriving.scenarios.Scenario)"
    )
    (tmp_path / "rules_of_a_user.py").write_text(
        RULE.replace("from codriving.scenarios.protocol import Scenario\n", "")
    )
    assert refused("rules_of_a_user.MyRule", "rules_of_a_user").endswith(
        "which is not where it was in release 0.1: JointPlanner (codriving.ordering.JointPlanner), "
        "OrderRule (codriving.ordering.OrderRule)"
    )


def test_a_name_that_is_gone_or_stands_twice_has_no_place() -> None:
    assert new_place("Probe") is None
    assert new_place("Metrics") == "codriving.datatypes.parts.Metric"
    assert new_place("Entrant") == "codriving.ordering.ApproachingVehicle"
