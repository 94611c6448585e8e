"""Flows are refused in one line, before anything is driven, where a part is not made for them."""

import pytest

from codriving.commands.compare import comparison_command
from codriving.commands.learn import run_learn
from codriving.commands.memory_build import build_points
from codriving.config.sweep import Point, expand
from codriving.errors import ConfigError
from codriving.experiment.plan import make_plan

REFUSED = [
    ("order=optimal", "choose another method or order, or flow=none"),
    ("method=bruteforce", "method 'bruteforce' decides for 10 CAVs at most, and in a flow there may be any number"),
    ("metrics=authors", "metrics 'authors' measures episodes and no flows"),
    ("memory=online", "a flow neither succeeds nor fails, so that nothing is learnt in it"),
    ("flow.arrivals=0", "flow.arrivals must be 1 to 3600 vehicles per hour and lane, got 0"),
    ("flow.arrivals=1800", "flow.arrivals must be below 3600 / headway, 1800 vehicles per hour and lane, got 1800"),
    ("flow.share=1.1", "flow.share must be 0 to 1, got 1.1"),
    ("flow.warm_up=-1", "flow.warm_up must be 0 to 3600 s, got -1"),
    ("flow.window=9", "flow.window must be 10 to 3600 s, got 9"),
    ("flow.cavs=4", "unknown key flow.cavs"),
]


@pytest.mark.parametrize(("override", "message"), REFUSED)
def test_what_no_flow_can_be_is_refused(override: str, message: str) -> None:
    with pytest.raises(ConfigError) as error:
        make_plan(expand(["flow=steady", override, "launcher=serial"]))
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_what_is_refused_in_a_flow_is_taken_for_episodes() -> None:
    make_plan(expand(["method=bruteforce", "metrics=authors", "launcher=serial"]))


def test_flows_and_episodes_are_not_mixed() -> None:
    with pytest.raises(ConfigError, match="flows and episodes have different tables"):
        make_plan(expand(["flow=none,steady", "launcher=serial"]))
    assert len(make_plan(expand(["flow=steady", "flow.arrivals=200,400", "launcher=serial"])).cells) == 2


def test_commands_that_count_successes_or_cavs_refuse_flows() -> None:
    load = comparison_command("load")
    point = Point(("flow=steady", "launcher=serial"))
    with pytest.raises(ConfigError, match="compare load varies the number of CAVs, which a flow does not have"):
        load.check(make_plan([point]))
    load.check(make_plan([Point(("launcher=serial",))]))
    with pytest.raises(ConfigError, match="nothing is learnt in it"):
        run_learn(["flow=steady", "launcher=serial"])
    with pytest.raises(ConfigError, match="nothing is learnt in it"):
        make_plan(build_points(["flow=steady", "launcher=serial"]))
