"""What every vehicle of ours adds to highway-env's: an id, and knowing where it is on its way."""

from highway_env.road.lane import AbstractLane
from highway_env.vehicle.objects import RoadObject

from codriving.environment.corrections import Corrections
from codriving.environment.motion import PlainMotion
from codriving.environment.way import Way


class OnWay(PlainMotion):
    """Mixin over highway-env's controlled vehicles.

    Attributes:
        id: Name of the vehicle, unique in the episode.
        way: The route that it follows, laid out.
        s: Arc length along the way [m].
        offset: Lateral offset from the way [m].
        shift: Lateral offset of the present lane's centre from the way [m]; 0 on the lane of the way itself.
        corrections: Which faults of the simulator are corrected.
    """

    id: str
    way: Way
    s: float
    offset: float
    shift: float = 0.0
    corrections: Corrections

    def take_way(self, name: str, way: Way, s: float, corrections: Corrections) -> None:
        """Put the vehicle on its way; call once after construction.

        Args:
            name: Id of the vehicle.
            way: The route that it follows, laid out.
            s: Arc length at which it starts [m].
            corrections: Which faults of the simulator are corrected.
        """
        self.id, self.way, self.s, self.offset, self.corrections = name, way, s, 0.0, corrections
        # From the present lane on: highway-env takes any other road if the plan does not begin with it or the next one.
        # No number where there are several lanes: it would bind drivers to that lane, and pull back CAVs that left it.
        graph = self.road.network.graph
        ahead = way.route.lanes[way.route.lanes.index(way.lane_at(s)) :]
        self.route = [(start, end, index if len(graph[start][end]) == 1 else None) for start, end, index in ahead]
        if corrections.route_lane:
            self._find_lane()
            self.target_lane_index = self.lane_index

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

        Args:
            other: The other vehicle.
            lane: Lane to measure along, instead of the own one.

        Returns:
            Distance between the centres, positive if the other is ahead [m].
        """
        if other is None or lane is not None or not self.corrections.route_leader:
            return float(super().lane_distance_to(other, lane))
        s, _ = self.way.path.project(float(other.position[0]), float(other.position[1]))
        return s - self.s
