"""The least sum of arrivals: a bound that no way of driving can fall below."""

import ctypes
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field

import numpy as np

from codriving.bound.meetings import Margins, MeetingPlace, kept_meetings, sure_meetings
from codriving.bound.passing import Passing
from codriving.bound.program import Program, pose
from codriving.bound.timetable import Timetable
from codriving.geometry import FloatArray, RoadMap

NODES = 20_000  # Nodes of the search at most; a limit of time would make the bound depend on the machine

SLACK = 1e-3  # What the solver's tolerances may add to its bound [s]


@dataclass(frozen=True, slots=True, eq=False)
class Bound:
    """What is proven of one scene, given the envelope."""

    total: float  # Least sum of the arrivals of its CAVs [s]
    alone: float  # Sum of their arrivals if each drives alone on the road [s]
    cavs: int
    binaries: int = 0
    optimal: bool = True  # Whether no larger bound can be had from the program
    arrivals: Mapping[str, float] = field(default_factory=dict)  # In the best timetable [s], by id
    # When each CAV passes which places in it (2, n) [m], [s]; in the order in which they start.
    times: tuple[FloatArray, ...] = ()


def lower_bound(
    cavs: Sequence[Passing],
    road_map: RoadMap,
    step: float,
    margins: Margins | None = None,
    one_order: bool = False,
) -> Bound:
    """Bound the sum of arrivals of some CAVs from below.

    Args:
        step: Simulation step, once in which the environment looks [s].
        margins: What an executor keeps; the bound is then one for this executor. None bounds all ways of driving.
        one_order: Whether CAVs pass all zones in one order of vehicles.
    """
    if margins is None:
        table = Timetable(cavs, list(sure_meetings(cavs, road_map, step)), 0.0, step)
    else:
        table = Timetable(cavs, list(kept_meetings(cavs, road_map, margins)), margins.time, step)
    return solved(table, pose(table, one_order))


def solved(table: Timetable, problem: Program) -> Bound:
    """Solve a program.

    Raises:
        ArithmeticError: If the solver contradicts itself.
    """
    # Nothing else needs scipy's optimizers, which take their time to import.
    from scipy.optimize import Bounds, LinearConstraint, milp

    with _quiet():
        found = milp(
            problem.cost,
            integrality=problem.whole,
            bounds=Bounds(problem.low, problem.high),
            constraints=LinearConstraint(problem.matrix.tocsr(), problem.least),
            options={"mip_rel_gap": 0.0, "node_limit": NODES},
        )
    alone = [cav.arrival for cav in table.cavs]
    earliest = [cav.least_arrival for cav in table.cavs]
    proven = found.mip_dual_bound if problem.whole.any() else found.fun
    if proven is None or not math.isfinite(proven):
        raise ArithmeticError(f"HiGHS found no bound: {found.message}")
    least = max(math.ceil((proven - SLACK) / table.step) * table.step, sum(earliest))
    if found.x is None:
        return Bound(round(least, 6), round(sum(alone), 6), len(table.cavs), problem.binaries, False)
    firsts = {
        number: _first(meeting, float(found.x[problem.orders[number]]) if number in problem.orders else None)
        for number, meeting in enumerate(table.meetings)
    }
    times = table.with_firsts(firsts)
    exact = [max(float(t[-1]), own) for t, own in zip(times, earliest, strict=True)]
    if proven > sum(exact) + table.step:
        raise ArithmeticError(
            f"HiGHS claims that CAVs need {proven:.4f} s, and its own order {sum(exact):.4f} s; please report this"
        )
    names = [cav.start.id for cav in table.cavs]
    return Bound(
        round(least, 6),
        round(sum(alone), 6),
        len(table.cavs),
        problem.binaries,
        found.status == 0,
        {name: round(time, 6) for name, time in zip(names, exact, strict=True)},
        tuple(np.array(rows) for rows in zip(table.places, times, strict=True)),
    )


def _first(meeting: MeetingPlace, order: float | None) -> int:
    if order is None:
        assert meeting.first is not None
        return meeting.first
    return meeting.i if order > 0.5 else meeting.j


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep off the screen a line for its developers that HiGHS 1.8 prints, whatever it is told."""
    with suppress(OSError):
        kept = os.dup(1)
        nothing = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, 1)
        try:
            yield
        finally:
            with suppress(OSError, AttributeError, TypeError):
                ctypes.CDLL(None).fflush(None)
            os.dup2(kept, 1)
            os.close(kept)
            os.close(nothing)
