"""What is driven to show that a change of the code changes no behaviour: cells, as a user types them."""

from collections.abc import Iterator
from dataclasses import dataclass

SEED, EPISODES = 10_000, 3
"""First seed and number of episodes of each cell."""

LIMITS = {"intersection": 20, "roundabout": 22, "highway": 10, "merge": 12}
"""How long an episode lasts at most [s]: through the junction, past the first lane changes, into the merge."""

METHODS = (
    "bruteforce", "codriving", "coop_game", "coop_game_auction", "coop_game_fuzzy", "dilu", "fcfs", "idfst", "madqn",
    "mcts", "noncoop_game", "pidm", "ppo", "tell",
)  # fmt: skip
ORDERING = ("bruteforce", "coop_game", "coop_game_auction", "fcfs", "idfst", "mcts")
"""Methods that drive by an order and so by an executor."""

CDA = ("agreement_seeking", "full", "intent_sharing", "prescriptive", "status_sharing")
OWN_ORDERS = ("own_view", "same_rule", "independent")
CORRECTIONS = (
    "no_reverse", "route_prediction", "route_leader", "route_lane", "yield_at_entry", "start_into_gap",
    "connected_lanes", "own_parameters", "remove_at_sink", "true_collisions",
)  # fmt: skip

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
    """

    name: str
    overrides: tuple[str, ...]
    command: tuple[str, ...] = ("run",)
    model: bool = False

    @property
    def typed(self) -> tuple[str, ...]:
        """The whole command but for the name of the run and the address of the model."""
        if self.command == ("memory", "build"):
            return (*self.command, *self.overrides, "launcher=serial")
        return (*self.command, *self.overrides, f"seed={SEED}", f"episodes={EPISODES}", "launcher=serial")


def _in(scenario: str, *more: str, limit: float | None = None) -> tuple[str, ...]:
    """A scenario, as long as it takes to see something."""
    return (f"scenario={scenario}", f"scenario.time_limit={limit or LIMITS[scenario]}", *more)


def _methods() -> Iterator[Cell]:
    for scenario in LIMITS:
        for method in METHODS:
            yield Cell(f"method {method} {scenario}", _in(scenario, f"method={method}"))
        for method in ORDERING:
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
    for scenario in LIMITS:
        for cda in CDA:
            yield Cell(f"cda {cda} {scenario}", _in(scenario, f"cda={cda}"))
        for order in OWN_ORDERS:
            for cda in ("intent_sharing", "status_sharing"):
                yield Cell(f"own_order {order} {cda} {scenario}", _in(scenario, f"cda={cda}", f"cda.own_order={order}"))
    yield Cell("ablate intersection", _in("intersection"), ("ablate",))
    yield Cell("ablate merge", _in("merge", "scenario.cavs=4"), ("ablate",))
    for off in ("state_sharing", "safety_check"):
        for scenario in ("roundabout", "highway"):
            yield Cell(f"without {off} {scenario}", _in(scenario, f"cda.{off}=false"))


def _environment() -> Iterator[Cell]:
    for name in CORRECTIONS:
        for scenario in ("roundabout", "merge"):
            overrides = _in(scenario, f"environment.corrections.{name}=false", "scenario.hdvs=[4,6]", limit=12)
            yield Cell(f"uncorrected {name} {scenario}", overrides)
    crowded = ("scenario.cavs=8", "scenario.hdvs=[4,4]")
    yield Cell("crowded codriving intersection", _in("intersection", *crowded))
    yield Cell("crowded mcts intersection", _in("intersection", "method=mcts", *crowded, limit=10))
    yield Cell("authors intersection", _in("intersection", "metrics=authors"))
    yield Cell("authors roundabout", _in("roundabout", "metrics=authors", "method=fcfs"))
    yield Cell("free_speed intersection", _in("intersection", "metrics.free_speed=9.0"))
    yield Cell("offline intersection", _in("intersection", "llm=offline"))


def _memories() -> Iterator[Cell]:
    for scenario in LIMITS:
        yield Cell(f"frozen codriving {scenario}", _in(scenario, *FROZEN))
        yield Cell(f"online codriving {scenario}", _in(scenario, "memory=online"))
        learning = _in(scenario, "interactions=3", "cda.safety_check=false")
        yield Cell(f"build {scenario}", learning, ("memory", "build"))
    yield Cell(
        "build words intersection", _in("intersection", "interactions=2", "memory.embedder=words"), ("memory", "build")
    )
    unchecked = ("cda.safety_check=false", "memory.least_similarity=0.8")
    yield Cell("frozen unchecked merge", _in("merge", *FROZEN, *unchecked))
    yield Cell("frozen first intersection", _in("intersection", *FROZEN, "memory.interactions=1", *unchecked))
    for scenario in ("intersection", "roundabout"):
        yield Cell(f"frozen dilu {scenario}", _in(scenario, "method=dilu", *FROZEN, "memory.least_similarity=0.8"))
        yield Cell(f"online dilu {scenario}", _in(scenario, "method=dilu", "memory=online"))


def _models() -> Iterator[Cell]:
    for scenario in LIMITS:
        yield Cell(f"model codriving {scenario}", _in(scenario, limit=10), model=True)
    junction = ("intersection", "roundabout")
    for scenario in junction:
        yield Cell(f"model dilu {scenario}", _in(scenario, "method=dilu", limit=10), model=True)
        yield Cell(f"model own order {scenario}", _in(scenario, "cda=status_sharing", limit=8), model=True)
    yield Cell("model binding intersection", _in("intersection", "cda=prescriptive", limit=8), model=True)
    yield Cell("model plain merge", _in("merge", "llm.ask_plain=true", limit=5), model=True)
    recalling = (*FROZEN, "memory.least_similarity=0.8")
    yield Cell("model frozen codriving merge", _in("merge", *recalling, limit=8), model=True)
    yield Cell("model frozen dilu intersection", _in("intersection", "method=dilu", *recalling, limit=8), model=True)
    reflecting = ("memory=online", "memory.reflection=llm", "cda.safety_check=false")
    for scenario in junction:
        yield Cell(f"model reflects codriving {scenario}", _in(scenario, *reflecting, limit=12), model=True)
        dilu = _in(scenario, "method=dilu", "memory=online", "scenario.cavs=8", limit=14)
        yield Cell(f"model reflects dilu {scenario}", dilu, model=True)


CELLS = (*_methods(), *_cooperation(), *_environment(), *_memories(), *_models())
