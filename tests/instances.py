"""Random ordering problems like those of a four-leg intersection with one lane in each direction."""

from collections.abc import Sequence
from random import Random

from codriving.datatypes.order import ApproachingVehicle, Instance
from codriving.reasoning.ordering.protocol import JointPlan
from codriving.reasoning.ordering.schedule import schedule

LEGS = ("south", "east", "north", "west")
TURNS = ("right", "straight", "left")

# Movements from the leg k/4 of a turn on that cross or meet those of the first leg, by turn: the textbook table.
MEETS = {
    "right": {1: (), 2: ("left",), 3: ("straight",)},
    "straight": {1: ("straight", "left", "right"), 2: ("left",), 3: ("straight", "left")},
    "left": {1: ("straight", "left"), 2: ("straight", "right"), 3: ("straight", "left")},
}


def meets(leg: int, turn: str, other_leg: int, other_turn: str) -> bool:
    """Whether two movements cross or meet; those from one leg are told apart by their lane."""
    return leg != other_leg and other_turn in MEETS[turn][(other_leg - leg) % 4]


class NoPlanner:
    """A planner for rules that do not ask one."""

    def plan(self, order: Sequence[str]) -> JointPlan:
        """Refuse."""
        raise AssertionError("this rule plans nothing")

    def gap_time(self, plan: JointPlan, one: str, other: str) -> float:
        """Refuse."""
        raise AssertionError("this rule asks for no gaps")


def instance(
    etas: dict[str, float],
    separation: dict[tuple[str, str], float] | None = None,
    before: Sequence[tuple[str, str]] = (),
    time: float = 0.0,
    **changes: dict[str, object],
) -> Instance:
    """Return a problem by hand; ``changes`` are attributes of single vehicles, by id."""
    vehicles = {name: ApproachingVehicle(name, 100.0, eta, crossing=2.0) for name, eta in etas.items()}
    for name, attributes in changes.items():
        for key, value in attributes.items():
            setattr(vehicles[name], key, value)
    return Instance(time, vehicles, separation or {}, frozenset(before))


def both(one: str, other: str, apart: float) -> dict[tuple[str, str], float]:
    """Return the separation of a pair that is the same in both directions."""
    return {(one, other): apart, (other, one): apart}


def crossroads(seed: int, n: int, windows: bool = False) -> Instance:
    """Return a random problem: vehicles on four legs, one behind another where they share one."""
    draw = Random(seed)
    vehicles: dict[str, ApproachingVehicle] = {}
    movement: dict[str, tuple[int, str]] = {}
    separation: dict[tuple[str, str], float] = {}
    before: set[tuple[str, str]] = set()
    last: dict[int, list[str]] = {leg: [] for leg in range(4)}
    for name in [f"CAV{k}" for k in range(n)]:
        leg, turn = draw.randrange(4), draw.choice(TURNS)
        ahead = last[leg]
        earliest = vehicles[ahead[-1]].eta + draw.uniform(0.8, 3.0) if ahead else draw.uniform(0.0, 5.0)
        vehicles[name] = ApproachingVehicle(
            name,
            100.0,
            earliest,
            turning=turn != "straight",
            leader=ahead[-1] if ahead else None,
            lane=LEGS[leg],
            stream=f"{LEGS[leg]}-{turn}",
            distance=earliest * 8,
            crossing=draw.uniform(1.5, 3.0),
            priority=leg % 2,
        )
        for other in ahead:
            before.add((other, name))
            separation[other, name], separation[name, other] = draw.uniform(0.8, 1.5), 0.0
        for other, (other_leg, other_turn) in movement.items():
            if meets(leg, turn, other_leg, other_turn):
                separation[other, name] = draw.uniform(0.8, 3.0)
                separation[name, other] = draw.uniform(0.8, 3.0)
        if windows and draw.random() < 0.5:
            begin = earliest + draw.uniform(-2.0, 4.0)
            vehicles[name].windows = [(begin, begin + draw.uniform(0.5, 3.0))]
        movement[name] = leg, turn
        ahead.append(name)
    return Instance(0.0, vehicles, separation, frozenset(before))


def is_valid(problem: Instance, order: Sequence[str], times: dict[str, float]) -> bool:
    """Whether an order with its times keeps what is fixed, all separations and all windows, early arrivals included."""
    place = {name: k for k, name in enumerate(order)}
    return (
        sorted(order) == sorted(problem.vehicles)
        and schedule(problem, order) is not None
        and all(times[n] >= e.eta for n, e in problem.vehicles.items())
        and all(not b < times[n] < e for n, v in problem.vehicles.items() for b, e in v.windows)
        and all(times[j] >= times[i] + w - 1e-9 for (i, j), w in problem.separation.items() if place[i] < place[j])
    )
