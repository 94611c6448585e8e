"""What is driven to show that a change of the code changes no behaviour: cells, as a user types them."""

import os
from collections.abc import Iterator
from dataclasses import dataclass

SEED, EPISODES = 10_000, 3
"""First seed and number of episodes of each cell."""

FULL = bool(os.environ.get("CI") or os.environ.get("SAMENESS"))
"""Whether all episodes are driven, as in CI; otherwise only the first of a cell whose episodes are independent."""

LIMITS = {"intersection": 20, "roundabout": 22, "highway": 10, "merge": 12}
"""How long an episode lasts at most [s]: through the junction, past the first lane changes, into the merge."""

METHODS = (
    "bruteforce", "codriving", "coop_game", "coop_game_auction", "coop_game_fuzzy", "dilu", "fcfs", "idfst", "madqn",
    "mcts", "noncoop_game", "pidm", "ppo", "tell",
)  # fmt: skip
ORDERING = ("bruteforce", "coop_game", "coop_game_auction", "fcfs", "idfst", "mcts")
"""Methods that drive by an order and so by an executor."""

CORRECTIONS = {
    "roundabout": ("route_prediction", "route_leader", "yield_at_entry", "true_collisions"),
    "merge": ("route_leader", "route_lane", "connected_lanes"),
}
"""Corrections of the simulator that make a difference by themselves, by the scenario in which they do."""

ALL_CORRECTIONS = (
    "no_reverse", "route_prediction", "route_leader", "route_lane", "yield_at_entry", "start_into_gap",
    "connected_lanes", "own_parameters", "remove_at_sink", "true_collisions",
)  # fmt: skip

CROWD = ("scenario.cavs=8", "scenario.hdvs=[4,4]")

MEMORY = "memory-0.1.sqlite"
"""A file of memories that version 0.1 has made; lies in the folder that cells are driven from."""

FROZEN = ("memory=frozen", f"memory.file={MEMORY}")


@dataclass(frozen=True)
class Cell:
    """A command.

    Attributes:
        name: What golden values and tests call it.
        overrides: What a user types after the command.
        command: The command; those that learn name their seeds themselves.
        model: Whether a language model answers, the one in ``model.py``.
        suite: The world; that of version 0.1 unless a cell is meant to show another.
    """

    name: str
    overrides: tuple[str, ...]
    command: tuple[str, ...] = ("run",)
    model: bool = False
    suite: str = "paper"

    @property
    def typed(self) -> tuple[str, ...]:
        """The whole command but for the name of the run and the address of the model."""
        if self.command == ("memory", "build"):
            return (*self.command, f"suite={self.suite}", *self.overrides, "launcher=serial")
        world = (*self.command, f"suite={self.suite}", *self.overrides)
        return (*world, f"seed={SEED}", f"episodes={self.episodes}", "launcher=serial")

    @property
    def episodes(self) -> int:
        """How many episodes are driven."""
        if self.suite != "paper":
            return 1
        learns = self.model or any("memory" in token for token in (*self.command, *self.overrides))
        return EPISODES if FULL or learns else 1


def _in(scenario: str, *more: str, limit: float | None = None) -> tuple[str, ...]:
    """A scenario, as long as it takes to see something."""
    return (f"scenario={scenario}", f"scenario.time_limit={limit or LIMITS[scenario]}", *more)


def _methods() -> Iterator[Cell]:
    for scenario in LIMITS:
        for method in METHODS:
            yield Cell(f"method {method} {scenario}", _in(scenario, f"method={method}"))
        # On the highway no ways cross, so that one method shows the executor as well as all.
        for method in ORDERING if scenario != "highway" else ("fcfs",):
            yield Cell(f"layered {method} {scenario}", _in(scenario, f"method={method}", "executor=layered"))
    # The default executor, named; and settings that the rules have beyond their defaults.
    yield Cell("planned fcfs intersection", _in("intersection", "method=fcfs", "executor=planned"))
    for mode in ("global", "reservation"):
        yield Cell(f"fcfs {mode} intersection", _in("intersection", "method=fcfs", f"method.rule.mode={mode}"))
    yield Cell("coop_game utility merge", _in("merge", "method=coop_game", "method.rule.objective=utility"))
    yield Cell("coop_game rational intersection", _in("intersection", "method=coop_game", "method.rule.rational=true"))
    # Whole episodes, so that everything that a score says is said of every road.
    for scenario in ("highway", "merge"):
        yield Cell(f"whole codriving {scenario}", _in(scenario, "method=codriving", limit=50))


def _cooperation() -> Iterator[Cell]:
    """The classes of cooperation; ``full`` is the default, so that ``method codriving`` has driven it already."""
    for scenario in LIMITS:
        for cda in ("intent_sharing", "prescriptive", "status_sharing"):
            yield Cell(f"cda {cda} {scenario}", _in(scenario, f"cda={cda}"))
        # With class A no conflict is seen, so that there is nothing to order.
        for order in ("same_rule", "independent"):
            own = _in(scenario, "cda.negotiation=false", f"cda.own_order={order}")
            yield Cell(f"own_order {order} {scenario}", own)
    for cda in ("agreement_seeking", "full"):
        yield Cell(f"cda {cda} intersection", _in("intersection", f"cda={cda}"))
    for cda in ("full", "prescriptive"):
        for scenario in ("intersection", "roundabout"):
            crowd = _in(scenario, f"cda={cda}", *CROWD, "cda.safety_check=false", limit=14)
            yield Cell(f"crowded {cda} {scenario}", crowd)
    for scenario in ("intersection", "merge"):
        yield Cell(f"ablate {scenario}", _in(scenario, "scenario.cavs=3", limit=11), ("ablate",))


def _environment() -> Iterator[Cell]:
    for scenario, names in CORRECTIONS.items():
        for name in names:
            uncorrected = _in(scenario, f"environment.corrections.{name}=false", "scenario.hdvs=[4,6]", limit=12)
            yield Cell(f"uncorrected {name} {scenario}", uncorrected)
    nothing = [f"environment.corrections.{name}=false" for name in ALL_CORRECTIONS]
    for scenario in LIMITS:
        yield Cell(f"uncorrected {scenario}", _in(scenario, *nothing))
    yield Cell("authors intersection", _in("intersection", "metrics=authors"))
    yield Cell("authors roundabout", _in("roundabout", "metrics=authors", "method=fcfs"))
    yield Cell("free_speed intersection", _in("intersection", "metrics.free_speed=9.0"))
    yield Cell("offline intersection", _in("intersection", "llm=offline"))


def _new_world() -> Iterator[Cell]:
    """The default world of today: limits, and human drivers who differ."""
    for scenario in LIMITS:
        for method in ("codriving", "fcfs", "mcts", "pidm"):
            yield Cell(f"default {method} {scenario}", _in(scenario, f"method={method}"), suite="default")


def _memories() -> Iterator[Cell]:
    """Memories are of the intersection and the merge; a low bar lets more of them count."""
    unchecked = ("cda.safety_check=false", "memory.least_similarity=0.8")
    for scenario in LIMITS:
        learning = _in(scenario, "interactions=3", "cda.safety_check=false")
        yield Cell(f"build {scenario}", learning, ("memory", "build"))
        yield Cell(f"online codriving {scenario}", _in(scenario, "memory=online", *unchecked))
    words = _in("intersection", "interactions=2", "memory.embedder=words")
    yield Cell("build words intersection", words, ("memory", "build"))
    for scenario in ("intersection", "merge"):
        yield Cell(f"frozen codriving {scenario}", _in(scenario, *FROZEN))
        yield Cell(f"frozen unchecked {scenario}", _in(scenario, *FROZEN, *unchecked))
    yield Cell("frozen first intersection", _in("intersection", *FROZEN, "memory.interactions=1", *unchecked))
    yield Cell("frozen dilu intersection", _in("intersection", "method=dilu", *FROZEN, "memory.least_similarity=0.5"))
    for scenario in ("roundabout", "merge"):
        yield Cell(f"online dilu {scenario}", _in(scenario, "method=dilu", "memory=online", *unchecked[1:]))


def _models() -> Iterator[Cell]:
    for scenario in LIMITS:
        yield Cell(f"model codriving {scenario}", _in(scenario, limit=6), model=True)
    yield Cell("model own order intersection", _in("intersection", "cda=intent_sharing", limit=6), model=True)
    yield Cell("model status roundabout", _in("roundabout", "cda=status_sharing", limit=6), model=True)
    yield Cell("model binding intersection", _in("intersection", "cda=prescriptive", limit=6), model=True)
    yield Cell("model plain merge", _in("merge", "llm.ask_plain=true", limit=3), model=True)
    recalling = (*FROZEN, "memory.least_similarity=0.8")
    yield Cell("model frozen codriving merge", _in("merge", *recalling, limit=6), model=True)
    yield Cell("model frozen dilu intersection", _in("intersection", "method=dilu", *recalling, limit=8), model=True)
    yield Cell("model dilu highway", _in("highway", "method=dilu", limit=6), model=True)
    reflecting = ("memory=online", "memory.reflection=llm", "cda.safety_check=false")
    yield Cell("model reflects codriving roundabout", _in("roundabout", *reflecting, limit=12), model=True)
    dilu = _in("intersection", "method=dilu", "memory=online", "scenario.cavs=8", limit=14)
    yield Cell("model reflects dilu intersection", dilu, model=True)


CELLS = (*_methods(), *_cooperation(), *_environment(), *_memories(), *_models(), *_new_world())
