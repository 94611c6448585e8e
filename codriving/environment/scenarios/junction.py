"""What scenes at junctions have in common: how CAVs come, what is turned, and an exit that is blocked."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np

from codriving.datatypes import Kind, LaneId, Route, Scene, Start, Turn
from codriving.environment.scenarios.placement import LENGTH, PlacedScenario, Suits, braking_gap, place
from codriving.errors import ScenarioError, require, require_range

LEGS = 4

WISHES = 2  # The exit that is blocked is one by which at least so many CAVs want to leave


@dataclass(kw_only=True, eq=False, repr=False)
class JunctionScenario(PlacedScenario):
    """Vehicles come by one of four legs and leave by another one."""

    exit_distance: float
    # YAMLs of release 0.1 have none of these.
    pattern: Literal["random", "standoff"] = "random"
    row_gap: float = 14.0
    turns: tuple[Turn, ...] = tuple(Turn)
    blocked_exit: float = 0.0
    blocked_room: float = 7.0

    def check_scene(self) -> None:
        """Refuse settings of the scene that are out of range, and more vehicles than there is room for."""
        require(
            0 < len(self.turns) == len(set(self.turns)),
            f"turns must name one or more of {', '.join(Turn)}, each once, got [{', '.join(self.turns)}]",
        )
        require_range("row_gap", self.row_gap, 6, 200, " m")
        require_range("blocked_exit", self.blocked_exit, 0, 600, " s")
        require_range("blocked_room", self.blocked_room, 1, 100, " m")
        require(
            not self.blocked_exit or self.blocked_room <= self.exit_distance,
            f"blocked_room must be at most exit_distance, {self.exit_distance:g} m, got {self.blocked_room:g}: past it "
            "vehicles have arrived",
        )
        if self.pattern == "standoff":
            self._check_rows()
            if self.blocked_exit and len(self.turns) == 1 and self.cavs <= LEGS:
                raise ScenarioError(
                    f"blocked_exit needs an exit that {WISHES} CAVs want, and {self.cavs} CAVs who come by a leg each "
                    f"and all go {self.turns[0]} want one each; use more turns or more than {LEGS} CAVs"
                )

    def _check_rows(self) -> None:
        rows, crowd = math.ceil(self.cavs / LEGS), self.crowd
        if rows > 1 and self.row_gap < (apart := crowd.apart(crowd.cav_speed[0])):
            raise ScenarioError(
                f"row_gap {self.row_gap:g} m leaves CAVs that start at {crowd.cav_speed[0]:g} m/s or more no room to "
                f"brake; use {apart:g} m or more, or a lower cav_speed or spacing"
            )
        if (last := crowd.start[1] - (rows - 1) * self.row_gap) < crowd.start[0]:
            raise ScenarioError(
                f"{self.cavs} CAVs on {LEGS} legs would start as far back as {last:g} m, and start begins at "
                f"{crowd.start[0]:g} m; use fewer CAVs, a smaller row_gap or a longer start interval"
            )
        free = sum(self._free((self.cavs + LEGS - 1 - leg) // LEGS) for leg in range(LEGS))
        if crowd.hdvs[1] > free:
            raise ScenarioError(
                f"up to {crowd.hdvs[1]} HDVs cannot start behind {self.cavs} CAVs in rows {self.row_gap:g} m apart "
                f"within {crowd.start[0]:g} to {crowd.start[1]:g} m along {LEGS} legs, where {free} have room; use "
                "fewer vehicles or a longer start interval"
            )

    def _free(self, cavs: int) -> int:
        """Largest number of human drivers that can start on a leg with some CAVs in rows."""
        if not cavs:
            return self.crowd.room
        apart = self.crowd.apart(min(self.cav_speed[0], self.hdv_speed[0]))
        behind = self.start[1] - (cavs - 1) * self.row_gap - self.start[0]
        return math.floor(behind / apart) + (cavs - 1) * max(math.floor(self.row_gap / apart) - 1, 0)

    @cached_property
    def ways(self) -> tuple[Route, ...]:
        """The routes that vehicles are drawn on."""
        return tuple(route for route in self.road.routes if route.turn in self.turns)

    @property
    def without_flows(self) -> str:
        if self.pattern != "random" or self.blocked_exit:
            return "pattern=standoff and blocked_exit say how an episode begins"
        return super().without_flows

    def draw(self, rng: np.random.Generator, name: str, kind: Kind) -> Start:
        route = self.ways[int(rng.integers(len(self.ways)))]
        return self.crowd.start_on(rng, name, kind, route.id, self.between(rng, name, kind, route))

    def between(self, rng: np.random.Generator, name: str, kind: Kind, route: Route) -> tuple[float, float] | None:
        """Return where on its route a vehicle may start, if not within ``start`` [m]."""
        if kind is Kind.HDV or self.pattern == "random":
            return None
        # A leg with a CAV in this row has no room for another one there, so that in the end each leg has one.
        row = (int(name.removeprefix("CAV")) - 1) // LEGS
        position = self.start[1] - row * self.row_gap
        return position, position

    def placed(self, seed: int, suits: Suits | None = None) -> Scene:
        """Draw a start for every vehicle but the one that blocks an exit."""
        return place(seed, self.crowd, self.road, self.draw, suits=suits)

    def scene(self, seed: int) -> Scene:
        if not self.blocked_exit:
            return self.placed(seed)
        scene = self.placed(seed, lambda starts: bool(self._blockable(starts)))
        exits = self._blockable(scene.starts)
        # Drawn apart, so that which exit is blocked changes no start.
        rng = np.random.default_rng(np.random.SeedSequence(entropy=seed, spawn_key=(3,)))
        lane = exits[int(rng.integers(len(exits)))]
        route = next(r for r in self.road.routes if r.lanes[-1] == lane and r.turn is Turn.STRAIGHT)
        name = f"HDV{sum(start.kind is Kind.HDV for start in scene.starts) + 1}"
        blocker = Start(name, Kind.HDV, route.id, self._blocked_at(route), 0.0, stands=self.blocked_exit)
        return replace(scene, starts=(*scene.starts, blocker))

    def _blocked_at(self, route: Route) -> float:
        """Return where on a route the vehicle stands that blocks its exit [m]."""
        return route.goal - self.exit_distance + self.blocked_room + LENGTH / 2

    def _blockable(self, starts: Sequence[Start]) -> list[LaneId]:
        """Return the exits that enough CAVs want, and before which all who want them can brake."""
        routes = {route.id: route for route in self.road.routes}
        wanted: dict[LaneId, list[Start]] = {}
        for start in starts:
            wanted.setdefault(routes[start.route].lanes[-1], []).append(start)
        return [
            lane
            for lane, by in sorted(wanted.items())
            if sum(start.kind is Kind.CAV for start in by) >= WISHES
            and all(self._blocked_at(routes[s.route]) - s.position >= LENGTH + braking_gap(s.speed, 0.0) for s in by)
        ]
