"""The control that knows the styles of human drivers, and that no other method can reach them."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import pytest
from source import files
from worlds import Junction, car

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.record import Outcome
from codriving.datatypes.situation import ReasonedDeliberation
from codriving.datatypes.world import Manner, WorldState
from codriving.environment.environment import Environment
from codriving.experiment.cells import make_cell
from codriving.experiment.episode import Labels, run_episode
from codriving.methods.control import Control
from codriving.methods.oracle import Oracle

Made = Callable[..., Environment]

NEVER, HIGHER = Manner("never", False, 0.8), Manner("to_higher_rank", False, 0.8)


@pytest.fixture(scope="module")
def oracle() -> Oracle:
    """The control as it is configured."""
    return build(compose(["method=oracle"])["method"], Oracle, "method")


def first(oracle: Oracle, junction: Junction, manners: Mapping[str, Manner]) -> str | None:
    """Who goes first: CAV1, which comes to the junction with the right of way, or a human driver who is as near."""
    oracle.reset(junction.road_map, replace(junction.model, steady=True), 3)
    oracle.be_told(manners)
    world = junction.world(car("CAV1", "east-west", 80.0, 8.0, 9.0), car("HDV1", "south-north", 76.0, 8.0))
    deliberation = oracle.act(world)
    assert isinstance(deliberation, ReasonedDeliberation)
    return deliberation.situations[0].order.first_of("CAV1", "HDV1")


def test_it_relies_on_those_who_give_way_and_on_no_others(oracle: Oracle, junction: Junction) -> None:
    assert first(oracle, junction, {}) == "CAV1"
    assert first(oracle, junction, {"HDV1": HIGHER}) == "CAV1"
    assert first(oracle, junction, {"HDV1": NEVER}) == "HDV1"
    assert first(oracle, junction, {"HDV2": NEVER}) == "CAV1"


class Watched(Environment):
    """Counts how often it is asked for the manners of human drivers."""

    asked = 0

    def manners(self) -> Mapping[str, Manner]:
        """Return them."""
        self.asked += 1
        return super().manners()


class Waits(Control):
    """Drives two steps, and notes what it was told."""

    def reset(self, *given: object) -> None:
        """Begin."""
        self.told: list[Mapping[str, Manner]] = []

    def be_told(self, manners: Mapping[str, Manner]) -> None:
        """Note it."""
        self.told.append(manners)

    def act(self, world: WorldState) -> ReasonedDeliberation:
        """Stop after two steps."""
        if world.step == 2:
            raise RuntimeError("that is enough")
        return ReasonedDeliberation(world.time, world.step, (), (), {})


@pytest.mark.parametrize("knows", [True, False])
def test_only_a_method_that_says_so_is_told(knows: bool, configured: Made, monkeypatch: pytest.MonkeyPatch) -> None:
    environment = configured("scenario=intersection", "limits=road", "drivers=rough", "scenario.hdvs=[4,4]")
    monkeypatch.setattr(environment, "__class__", Watched)
    method = Waits.__new__(Waits)
    method.knows_drivers, method.hands_over = knows, True
    result = run_episode(environment, method, {}, 10_000, Labels("a", "b", "", ""))
    assert "that is enough" in result.record.outcome.message
    assert isinstance(environment, Watched)
    assert environment.asked == len(method.told) == (3 if knows else 0)
    assert isinstance(result.record.outcome, Outcome)
    if knows:
        assert method.told[0].keys() == {"HDV1", "HDV2", "HDV3", "HDV4"}
        assert {m.gives_way for m in method.told[0].values()} <= {"by_rule", "to_higher_rank", "never"}
        assert all(0.5 <= m.reaction <= 1.1 and m.distraction in (0.0, 1.2) for m in method.told[0].values())


def test_a_world_state_holds_nothing_of_it(configured: Made) -> None:
    environment = configured("scenario=intersection", "limits=road", "drivers=rough", "scenario.hdvs=[4,4]")
    world = environment.reset(10_000)
    styles = {track.style for track in environment.trajectory().tracks} - {""}
    assert styles, "the record knows them"
    for word in (*styles, "rule", "rank", "never", "reaction", "hesita", "style", "Manner"):
        assert word not in repr(world)


def test_no_other_file_of_the_methods_says_that_it_is_told() -> None:
    found = [
        str(file)
        for file in files()
        if file.room == "methods" and "knows_drivers = True" in file.path.read_text("utf-8")
    ]
    assert [name.rpartition("/")[2] for name in found] == ["oracle.py"]


def test_tables_say_of_whatever_method_is_told_that_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    assert make_cell(compose(["method=oracle"])).remark.count("which no vehicle can know.") == 1
    monkeypatch.setattr(Control, "knows_drivers", True)
    said = make_cell(compose(["method=fastest"])).remark
    assert said.endswith(" fastest: it is told how human drivers treat the right of way, which no vehicle can know.")
    assert said.startswith("fastest: a control and no method: ")
