"""What every vehicle of ours adds to highway-env's: an id, and knowing where it is on its way."""

import math
from collections.abc import Mapping

from highway_env.road.lane import AbstractLane
from highway_env.vehicle.objects import RoadObject

from codriving.datatypes.road import beside
from codriving.datatypes.scene import Start
from codriving.environment.corrections import Corrections
from codriving.environment.motion import PlainMotion
from codriving.environment.traffic.way import Way


class OnWay(PlainMotion):
    """Mixin over highway-env's controlled vehicles.

    Attributes:
        s: Arc length along the way [m].
        offset: Lateral offset from the way [m].
        shift: Lateral offset of the present lane's centre from the way [m]; 0 on the lane of the way itself.
    """

    id: str
    way: Way
    ways: Mapping[str, Way]
    s: float
    offset: float
    shift: float = 0.0
    corrections: Corrections

    def take_way(self, start: Start, ways: Mapping[str, Way], corrections: Corrections) -> None:
        """Put the vehicle on its way; call once after construction."""
        self.id, self.ways, self.corrections = start.id, ways, corrections
        self.way, self.s, self.offset = ways[start.route], start.position, 0.0
        self._plan()
        if corrections.route_lane:
            self._find_lane()
            self.target_lane_index = self.lane_index

    def _plan(self) -> None:
        """Hand the rest of the way to highway-env."""
        # From the present lane on: highway-env takes any other road if the plan does not begin with it or the next one.
        # No number where there are several lanes: it would bind drivers to that lane, and pull back CAVs that left it.
        # Where the route asks for a lane change, the lane to change to: there drivers change as soon as it is safe.
        graph = self.road.network.graph
        left = self.way.route.lanes if self.way.changes_after(self.s) else ()
        self.route = [
            (a, b, k if len(graph[a][b]) == 1 or any(beside((a, b, k), lane) for lane in left) else None)
            for a, b, k in self.way.plan(self.s)
        ]

    def follow_target_lane(self) -> None:
        """Take the way along the lane that is steered for, if another lane than that of the way was chosen.

        Of the routes along that lane which end where the present one does, one that needs the fewest further changes,
        and had the fewest before.
        """
        target = (self.target_lane_index[0], self.target_lane_index[1], int(self.target_lane_index[2]))
        present = self.way.lane_at(self.s)
        leaves = self.way.ending is not None and target != self.way.ending and self.s < self.way.lane_end
        if not (beside(target, present) or (target == present and leaves)):
            return
        x, y = self.position.tolist()
        options = []
        for name, way in self.ways.items():
            if target in way.route.lanes and way.route.lanes[-1][1] == self.way.route.lanes[-1][1]:
                s, offset = way.path.project(x, y)
                if way.lane_at(s) == target:
                    options.append((way.changes_after(s), way.changes_after(-math.inf), name, s, offset))
        if options:
            *_, name, self.s, self.offset = min(options)
            self.way = self.ways[name]
            self._plan()
            self._find_lane()

    def on_state_update(self) -> None:
        """Update the lane after a step of the dynamics."""
        if not self.corrections.route_lane:
            super().on_state_update()
        x, y = self.position.tolist()
        self.s, self.offset = self.way.follow(x, y, self.s)
        if self.corrections.route_lane:
            self._find_lane()

    def _find_lane(self) -> None:
        start, end, index = self.way.lane_at(self.s)
        lanes = self.road.network.graph[start][end]
        self.shift = 0.0
        if len(lanes) > 1:
            sides = [lane.local_coordinates(self.position) for lane in lanes]
            index = min(range(len(lanes)), key=lambda i: abs(sides[i][1]))
            self.shift = self.offset - sides[index][1]
        self.lane_index = (start, end, index)
        self.lane = lanes[index]

    def step(self, dt: float) -> None:
        """Move by one simulation step, never backwards if that is corrected.

        Args:
            dt: Simulation step [s].
        """
        self.move(dt)
        if self.corrections.no_reverse and self.speed < 0:
            self.speed = 0.0

    def lane_distance_to(self, other: RoadObject | None, lane: AbstractLane | None = None) -> float:
        """Return the signed distance to another vehicle, along the way where that is corrected.

        Returns:
            Distance between the centres, positive if the other is ahead [m].
        """
        if other is None or lane is not None or not self.corrections.route_leader:
            return float(super().lane_distance_to(other, lane))
        s, _ = self.way.path.project(float(other.position[0]), float(other.position[1]))
        return s - self.s
