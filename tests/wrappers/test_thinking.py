"""``thinking``: around which methods time passes, what is said of it, and what it is in a config and a run."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from driven import drive, planned
from thinkers import Backwards
from typer.testing import CliRunner
from worlds import FULL, Junction, car

from codriving.cli.app import app
from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.parts import Method, RuleModel, ThinkingTime
from codriving.datatypes.situation import Decision, Deliberation, ReasonedDeliberation
from codriving.datatypes.world import Action, WorldState
from codriving.environment.environment import Environment
from codriving.errors import ConfigError
from codriving.experiment.objects import make_method
from codriving.methods.codriving import CoDriving
from codriving.methods.idm import Idm
from codriving.methods.ordered import Ordered
from codriving.reasoning.sharing.sharing import CdaLevel
from codriving.runs.identity import driving_values
from codriving.wrappers.delays import Delays
from codriving.wrappers.filtered import Filtered, SafetyFilter
from codriving.wrappers.slow import Slow, SlowCoDriving
from codriving.wrappers.thinking import Thinking

FREE = (car("CAV1", "south-north", 20.0, 8.0), car("CAV2", "west-east", 20.0, 8.0))
STANDS = car("HDV1", "south-north", 32.0, 0.0)


def thinking(mind: float = 0.0, order: float = 0.0) -> Thinking:
    return Thinking(mind, order, CdaLevel(**FULL))


def codriving(**change: Any) -> CoDriving:
    return CoDriving(CdaLevel(**{**FULL, **change}), RuleModel(), None, 1.5)


class Wants(Method):
    """Wants the same for all CAVs, and notes when."""

    name = "wants"

    def __init__(self, action: Action) -> None:
        self.action = action
        self.asked: list[float] = []

    def reset(self, *given: object) -> None:
        """Nothing."""

    def act(self, world: WorldState) -> Deliberation:
        self.asked.append(world.time)
        decisions = tuple(Decision(cav.id, self.action, "I like it") for cav in world.cavs)
        return ReasonedDeliberation(world.time, world.step, (), decisions, {"liked": 2}, ({"purpose": "x"},))


def slow(junction: Junction, method: Method, mind: float = 0.0, order: float = 0.0) -> Method:
    made = thinking(mind, order).around(method, None)
    made.reset(junction.road_map, junction.model, 3)
    return made


def test_a_method_that_takes_no_time_is_left_as_it_is() -> None:
    for method in (codriving(), Wants(Action.IDLE), Idm(), Ordered(Backwards(), planned())):
        assert thinking().around(method, RuleModel()) is method
        assert ThinkingTime().around(method, None) is method
    for method in (Wants(Action.IDLE), codriving(negotiation=False), Idm()):
        assert thinking(order=2.0).around(method, None) is method, "there is no order to be late"
    assert thinking(mind=1.0).around(idm := Idm(), None) is idm


@pytest.mark.parametrize(("mind", "order"), [(1.0, 0.0), (0.0, 1.0)])
def test_what_is_put_around_which_method(mind: float, order: float) -> None:
    assert type(thinking(mind, order).around(codriving(), None)) is SlowCoDriving
    assert type(thinking(mind, order).around(Ordered(Backwards(), planned()), None)) is Slow
    unchecked = codriving(safety_check=False)
    filtered = thinking(mind, order).around(SafetyFilter(CdaLevel(**FULL), 1.5).around(unchecked), None)
    assert type(filtered) is Filtered
    assert type(filtered.method) is SlowCoDriving
    wide = SafetyFilter(CdaLevel(**FULL), 2.5).around(Ordered(Backwards(), planned()))
    made = thinking(mind, order).around(wide, None)
    assert isinstance(made, Slow)
    assert (made.margin, made.is_checked, made.variant) == (2.5, True, "filtered")


def test_what_is_said_of_methods() -> None:
    both = thinking(1.0, 2.0)
    assert both.notes(both.around(codriving(), None)) == (
        "Thinking takes time (thinking.mind=1 s, thinking.order=2 s): the safety check drives {} meanwhile, and checks "
        "late answers.",
    )
    assert "{}: it has no mind" in both.notes(Idm())[0]
    assert "{}: there is no common order in it" in thinking(order=2.0).notes(Wants(Action.IDLE))[0]
    assert thinking().notes(codriving()) == ()


def test_any_other_method_acts_late_behind_the_check(junction: Junction) -> None:
    method = Wants(Action.FASTER)
    made = slow(junction, method, 1.0)
    worlds = [junction.world(*FREE, time=0.5 * k, step=k) for k in range(4)]
    worlds += [junction.world(*FREE, STANDS, time=2.0, step=4)]
    found = [made.act(world) for world in worlds]
    assert [f.actions["CAV2"] for f in found] == [Action.IDLE, Action.IDLE, Action.FASTER, Action.IDLE, Action.FASTER]
    assert method.asked == [0.0, 1.0, 2.0]
    assert found[4].actions["CAV1"] is Action.SLOWER
    assert [f.counts["dropped_decisions"] for f in found] == [0, 0, 0, 0, 1]
    assert [f.counts["late_decisions"] for f in found] == [0, 0, 2, 0, 1]
    assert [f.counts.get("liked", 0) for f in found] == [2, 0, 2, 0, 2]
    assert [len(f.transcript) for f in found] == [1, 0, 1, 0, 1]
    line = found[2].as_dict()["cavs"][0]
    assert (line["action"], line["reason"]) == ("FASTER", "thought of 1.0 s ago: I like it")
    assert "HOLD" not in line["allowed"]
    assert line["scene"]["intent"]["route"] == "south-north"


def test_an_answer_that_takes_no_time_gives_way_to_the_nearest_that_is_allowed(junction: Junction) -> None:
    made = Slow(Wants(Action.FASTER), CdaLevel(**FULL), 1.5, Delays(0.0, 1.0))
    made.reset(junction.road_map, junction.model, 3)
    found = made.act(junction.world(*FREE, STANDS))
    assert found.actions == {"CAV1": Action.SLOWER, "CAV2": Action.FASTER}
    assert "in the place of FASTER, which the safety check removed" in found.decisions[0].reason
    assert found.counts["reflexes"] == 0


@pytest.fixture(scope="module")
def environment(configured: Callable[..., Environment]) -> Environment:
    return configured("suite=standoff", "limits=road", "environment.steady=true")


@pytest.mark.parametrize("name", ["codriving", "fcfs", "pidm"])
def test_whole_episodes_are_driven_late_and_alike(name: str, environment: Environment) -> None:
    config = compose([f"method={name}", "thinking.mind=1", "thinking.order=2"])
    steps = []
    for _ in range(2):
        driven = drive(environment, make_method(config, RuleModel(), None), 20001, 30)
        steps.append([step.as_dict() for step in driven.steps])
        total = {k: sum(step.counts[k] for step in driven.steps) for k in ("late_decisions", "reflexes", "late_orders")}
        assert total["late_decisions"] > 20
        assert total["reflexes"] > 40
        assert (total["late_orders"] > 1) == (name != "pidm")
    assert steps[0] == steps[1]


@pytest.mark.parametrize(("key", "value"), [("mind", -0.5), ("mind", 31.0), ("order", -1.0), ("order", 30.5)])
def test_a_time_out_of_range_is_refused(key: str, value: float) -> None:
    with pytest.raises(ConfigError, match=f"thinking.{key} must be 0 to 30 s, got {value:g}"):
        build(compose([f"thinking.{key}={value}"])["thinking"], ThinkingTime, "thinking")


def test_a_time_is_part_of_a_run_and_none_is_not() -> None:
    assert "thinking" not in driving_values(compose([]))
    assert driving_values(compose(["thinking.order=1"]))["thinking"] == {"mind": 0.0, "order": 1.0}


def test_late_answers_are_counted_in_record_and_tables(tmp_path: Path) -> None:
    settings = ["suite=crowd", "episodes=1", "seed=20000", "scenario.time_limit=6", f"output={tmp_path}", "run=mine"]
    result = CliRunner().invoke(app, ["run", "launcher=serial", "thinking.mind=1", "thinking.order=0,2", *settings])
    assert result.exit_code == 0, result.output
    times = "thinking.mind=1 s, thinking.order=2 s"
    assert f"Thinking takes time ({times}): the safety check drives codriving meanwhile" in result.stdout
    folder = tmp_path / "run" / "mine"
    header, *rows = (folder / "summary.csv").read_text().splitlines()
    for name in ("late_decisions", "dropped_decisions", "late_orders", "dropped_orders", "reflexes", "thinking.order"):
        assert name in header.split(",")
    assert len(rows) == 2
    counts = [json.loads(path.read_text())["counts"] for path in sorted(folder.glob("episodes/*/*/record.json"))]
    assert all(found["late_decisions"] > 0 for found in counts)
    assert sorted(found["late_orders"] > 0 for found in counts) == [False, True]
    refused = CliRunner().invoke(app, ["run", "thinking.mind=long"])
    assert refused.exit_code == 2
    assert refused.stderr.splitlines() == ["error: thinking.mind must be a number, got 'long'"]


def first_proposal(environment: Environment, *overrides: str) -> float | None:
    """When the first order is proposed in 3 s, of those that are sent as messages."""
    method = make_method(compose(["v2x=good", *overrides]), RuleModel(), None)
    environment.observer = method.observer
    world = environment.reset(20001)
    method.reset(environment.road_map, environment.driving_model, 3)
    for _ in range(6):
        deliberation = method.act(world)
        if deliberation.as_dict()["said"]:
            return world.time
        world = environment.step(deliberation.actions)
    return None


@pytest.mark.parametrize("name", ["codriving", "fcfs"])
def test_what_is_proposed_by_messages_comes_late(name: str, environment: Environment) -> None:
    begin = first_proposal(environment, f"method={name}")
    assert begin is not None
    assert first_proposal(environment, f"method={name}", "thinking.order=1.2") == begin + 1.5
