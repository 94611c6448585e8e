"""A method whose CAVs hear of one another by messages: a copy for each CAV, which decides by what that one knows."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import pytest
from driven import Episode, drive
from hearing import FLAWLESS
from worlds import Junction, car

from codriving.config.compose import compose
from codriving.datatypes.parts import Account, Method, Shares
from codriving.datatypes.record import Ending, Outcome
from codriving.datatypes.situation import Decision, Deliberation, ReasonedDeliberation
from codriving.datatypes.world import Action, Manner, WorldState
from codriving.environment.environment import Environment
from codriving.experiment.objects import make_objects
from codriving.v2x.connected import V2X, Connected
from codriving.v2x.misbehaviour import Misconduct

SCENARIOS = ("intersection", "roundabout", "highway", "merge")

BY_ITSELF = "v2x.coordination.by=none"  # Orders are computed, and no message carries one

NOTHING_WRONG = tuple(f"v2x.{key}={value}" for key, value in FLAWLESS.items() if not key.endswith("bytes"))


def method_of(*overrides: str) -> Method:
    """The method of a config, without a language model."""
    return make_objects(compose([*overrides])).method


def driven(*overrides: str, decisions: int) -> tuple[Episode, Method]:
    """An episode of a config, as long as asked for."""
    made = make_objects(compose([*overrides]))
    assert isinstance(made.environment, Environment)
    made.environment.observer = made.method.observer
    return drive(made.environment, made.method, 20_007, decisions), made.method


@pytest.mark.parametrize("scenario", SCENARIOS)
def test_without_age_loss_noise_and_end_of_range_all_is_as_without_a_channel(scenario: str) -> None:
    """Equal, but for what says how old things are: each copy comes to the common order by itself.

    An order that is agreed on by messages comes a decision later. A vehicle that all have lost sight of is remembered
    for the validity.
    """
    plain, _ = driven(f"scenario={scenario}", decisions=10)
    heard, method = driven(
        f"scenario={scenario}", "v2x=good", *NOTHING_WRONG, "v2x.validity=0", BY_ITSELF, decisions=10
    )
    assert isinstance(method, Connected)
    assert heard.actions == plain.actions
    assert heard.worlds == plain.worlds
    lines = [[step.as_dict() for step in episode.steps] for episode in (heard, plain)]
    told = [n.pop("told") for line in lines[0] for entry in line["cavs"] for n in _known(entry) if "told" in n]
    assert lines[0] == lines[1]
    assert told
    assert {(t["age"], t["behind"], t["ahead"], t["slower"], t["faster"]) for t in told} == {(0.0,) * 5}


def test_with_all_shares_0_a_run_is_as_if_no_cav_could_misbehave(monkeypatch: pytest.MonkeyPatch) -> None:
    typed = ("scenario=intersection", "v2x=urban")
    found, _ = driven(*typed, decisions=8)
    monkeypatch.setattr(Misconduct, "kind_of", lambda *_: "")
    monkeypatch.setattr(Misconduct, "sent", lambda _self, _cav, messages, _world: messages)
    monkeypatch.setattr(Misconduct, "ghosts", lambda *_: iter(()))
    without, _ = driven(*typed, decisions=8)
    assert (found.worlds, found.actions) == (without.worlds, without.actions)
    assert [(step.as_dict(), step.counts) for step in found.steps] == [
        (step.as_dict(), step.counts) for step in without.steps
    ]
    monkeypatch.setattr(Misconduct, "sent", lambda *_: ())
    silent, _ = driven(*typed, decisions=8)
    assert silent.steps[-1].as_dict() != found.steps[-1].as_dict()


def _known(entry: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The vehicles in an entry of decisions.jsonl."""
    return list(entry["scene"]["neighbours"])


def test_the_new_keys_of_decisions_are_these() -> None:
    plain, _ = driven("scenario=intersection", decisions=3)
    heard, _ = driven("scenario=intersection", "v2x=poor", BY_ITSELF, decisions=12)
    first, last = plain.steps[0].as_dict(), heard.steps[-1].as_dict()
    assert first.keys() == last.keys() == {"time", "step", "cavs"}
    assert first["cavs"][0].keys() == last["cavs"][0].keys()
    assert all("told" not in n for step in plain.steps for e in step.as_dict()["cavs"] for n in _known(e))
    told = [n["told"] for step in heard.steps for e in step.as_dict()["cavs"] for n in _known(e) if "told" in n]
    keys = {"age", "intent_age", "seen", "behind", "ahead", "aside", "slower", "faster", "since"}
    assert {frozenset(t) for t in told} == {frozenset(keys)}
    # Of what is seen only the intent has an age.
    assert any(t["seen"] and t["age"] == 0 and t["intent_age"] == 1.0 for t in told)
    assert any(not t["seen"] and t["age"] >= 1.0 and t["ahead"] > 1.0 for t in told)
    assert {(t["since"] is None) for t in told if t["intent_age"] is not None} == {True}


@pytest.fixture(scope="module")
def links() -> dict[str, dict[tuple[str, str], list[float]]]:
    """What each link has lost, by method."""
    found = {}
    for name in ("codriving", "fcfs", "madqn", "codriving cda=status_sharing"):
        _, method = driven("scenario=intersection", "v2x=poor", *f"method={name}".split(), decisions=8)
        assert isinstance(method, Connected)
        channel = method._channel
        cavs = [pair for pair in channel._links if all(end.startswith("CAV") for end in pair)]
        found[name] = {pair: [channel._links[pair].delay(tick) for tick in range(80)] for pair in cavs}
    return found


def test_the_same_seed_gives_every_method_the_same_losses(
    links: dict[str, dict[tuple[str, str], list[float]]],
) -> None:
    ours = links["codriving"]
    assert len(ours) == 12  # Of four CAVs
    for other in links.values():
        assert other == ours
    lost = [math.isinf(delay) for delays in ours.values() for delay in delays]
    assert 0.15 < sum(lost) / len(lost) < 0.45


@pytest.mark.parametrize(
    ("typed", "shares"),
    [
        ("method=codriving", (True, True, True)),
        ("method=codriving cda=intent_sharing", (True, True, False)),
        ("method=codriving cda=status_sharing", (True, False, False)),
        ("method=codriving cda.state_sharing=false", (False, True, True)),
        ("method=codriving order=fcfs", (True, True, True)),
        ("method=fastest", (True, True, True)),
        ("method=random_order", (True, True, True)),
        ("method=oracle", (True, True, True)),
        ("method=fcfs", (True, True, True)),
        ("method=mcts", (True, True, True)),
        ("method=coop_game_fuzzy", (True, True, True)),
        ("method=madqn", (True, True, False)),
        ("method=madqn filter=true", (True, True, False)),
        ("method=ppo filter=true", (True, True, False)),
        ("method=pidm filter=true cda=status_sharing", (True, False, False)),
        ("method=pidm thinking.mind=1", (True, True, False)),
    ],
)
def test_a_method_that_shares_is_copied_for_each_cav(typed: str, shares: tuple[bool, bool, bool]) -> None:
    method = method_of(*typed.split(), "v2x=good")
    assert isinstance(method, Connected)
    assert (method.shares.states, method.shares.intents, method.shares.orders) == shares
    assert not isinstance(method_of(*typed.split(), "v2x=perfect"), Connected)


@pytest.mark.parametrize("name", ["pidm", "ppo", "tell", "dilu", "noncoop_game", "idm", "idm filter=true"])
def test_a_method_that_shares_nothing_is_left_as_it_is(name: str) -> None:
    assert not isinstance(method_of(*f"method={name}".split(), "v2x=good"), Connected)


class Telling(Method):
    """Notes what it is asked; every CAV of its world does what its id says."""

    name, reasoner, knows_drivers, shares = "telling", "rules", True, Shares(states=True, intents=True)

    def __init__(self) -> None:
        self.asked: list[object] = []
        self.common = object()

    def reset(self, *given: object) -> None:
        self.asked.append(("seed", given[2]))
        TOLD.append(self)

    def be_told(self, manners: Mapping[str, Manner]) -> None:
        self.asked.append(("told", manners))

    def act(self, world: WorldState) -> Deliberation:
        self.asked.append(("act", world.viewer))
        decisions = tuple(Decision(c.id, Action.IDLE, f"{world.viewer} for {c.id}") for c in world.cavs)
        counts, asked = {"liked": 2, "seen": len(world.vehicles)}, ({"by": world.viewer},)
        return Plain(world.time, world.step, (), decisions, counts, asked)

    def conclude(self, world: WorldState, outcome: Outcome) -> Account:
        return {"learnt": 1}, [{"end": 1}]

    def unfinished_step(self, time: float) -> Account:
        return {"paid": 1}, []


TOLD: list[Telling] = []
"""The copies that were made, in their order."""


class Plain(ReasonedDeliberation):
    """Says of each CAV no more than why it does what it does."""

    def as_dict(self) -> dict[str, Any]:
        return {"cavs": [{"id": d.ego, "reason": d.reason} for d in self.decisions]}


CARS = (
    car("CAV1", "south-north", 60.0, 5.0),
    car("CAV2", "south-north", 40.0, 5.0),
    car("HDV1", "south-north", 80.0, 5.0),
)


def test_each_copy_decides_for_its_own_cav_and_all_is_added_up(junction: Junction) -> None:
    TOLD.clear()
    inner = Telling()
    method = V2X(**FLAWLESS).between(inner, [inner.common])
    assert isinstance(method, Connected)
    method.reset(junction.road_map, junction.model, 7)
    manners = {"HDV1": Manner("never", False, 0.8)}
    method.be_told(manners)
    deliberation = method.act(junction.world(*CARS))
    assert deliberation.actions == {"CAV1": Action.IDLE, "CAV2": Action.IDLE}
    line = deliberation.as_dict()
    assert (line["time"], line["step"]) == (0.0, 0)
    assert [entry["reason"] for entry in line["cavs"]] == ["CAV1 for CAV1", "CAV2 for CAV2"]
    assert deliberation.counts == {
        "liked": 4,
        "seen": 6,
        "messages": 6,
        "message_bytes": 2 * (350 + 240 + 35 + 300),
        "message_age": 0.0,
        "message_uses": 2,
    }
    assert deliberation.transcript == ({"by": "CAV1"}, {"by": "CAV2"})
    assert [copy.asked for copy in TOLD] == [
        [("seed", 7), ("told", manners), ("act", "CAV1")],
        [("seed", 7), ("told", manners), ("act", "CAV2")],
    ]
    # What all use together is not copied.
    assert {id(copy.common) for copy in TOLD} == {id(inner.common)}
    outcome = Outcome(Ending.SUCCESS, 0.5, {})
    sent = {"messages": 0, "message_bytes": 0}
    assert method.conclude(junction.world(*CARS), outcome) == (sent | {"learnt": 2}, [{"end": 1}] * 2)
    assert method.unfinished_step(1.0) == (sent | {"paid": 2}, [])


def test_what_is_sent_after_the_last_decision_counts(junction: Junction) -> None:
    method = V2X(**FLAWLESS).between(Telling(), [])
    method.reset(junction.road_map, junction.model, 7)
    method.act(junction.world(*CARS))
    assert method.observer is not None
    for tick in range(1, 4):
        method.observer(junction.world(*CARS, time=tick / 10))
    counts, _ = method.conclude(junction.world(*CARS), Outcome(Ending.SUCCESS, 0.3, {}))
    assert (counts["messages"], counts["message_bytes"]) == (18, 3 * 2 * (350 + 240 + 35 + 300))


def test_the_simulator_shows_the_world_at_each_step(configured: Callable[..., Environment]) -> None:
    environment = configured("scenario=intersection")
    seen: list[float] = []
    environment.observer = lambda world: seen.append(world.time)
    world = environment.reset(3)
    environment.step(dict.fromkeys(world.available, Action.IDLE))
    step = environment.driving_model.step
    assert seen == pytest.approx([step * (k + 1) for k in range(environment.driving_model.substeps)])
