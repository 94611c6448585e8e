"""The environment module of the paper: a scene becomes a world that answers to decisions."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from codriving.datatypes import (
    Action,
    ControlInput,
    DrivingModel,
    Flow,
    Kind,
    Manner,
    Outcome,
    Scenario,
    Scene,
    Simulator,
    Start,
    Trajectory,
    VehicleLimits,
    WorldState,
)
from codriving.environment.alone import drive_alone
from codriving.environment.arrivals import Newcomer, Outside, draw_newcomers, entries
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.counting import Counting
from codriving.environment.drivers.style import DriverMix
from codriving.environment.network import build_network
from codriving.environment.recorder import Recorder, human_routes, snapshot
from codriving.environment.settings import ControlGains, Corrections, DriverProfile
from codriving.environment.termination import Termination
from codriving.environment.traffic.human_driver import HumanDriver
from codriving.environment.traffic.route_following import RoutePath, route_path
from codriving.environment.traffic.traffic import Traffic
from codriving.environment.traffic.unguided import take_over
from codriving.errors import EpisodeError, ScenarioError
from codriving.geometry import FloatArray, RoadMap, road_map

REMEMBERED = 200  # Scenes of which it is remembered how each vehicle drives alone

LONGEST = 600.0  # How long a vehicle of a flow drives alone at most; a flow has no time limit [s]

_ALONE: dict[tuple[RoadMap, str], Mapping[str, FloatArray]] = {}


class Environment(Simulator):
    """Several CAVs and human drivers on one road, on highway-env's physics.

    Raises:
        ScenarioError: If the road is not consistent in itself, or takes no flows.
    """

    _termination: Termination | Counting

    def __init__(
        self,
        scenario: Scenario,
        control: ControlGains,
        drivers: DriverProfile | DriverMix,
        corrections: Corrections,
        limits: VehicleLimits | None = None,
        flow: Flow | None = None,
        steady: bool = False,
    ) -> None:
        self.scenario, self.control, self.drivers, self.corrections = scenario, control, drivers, corrections
        self.limits, self.flow = limits, flow
        if flow is not None and scenario.without_flows:
            raise ScenarioError(
                f"{scenario.name} takes no flows: {scenario.without_flows}; change that, or leave flow out"
            )
        pace = scenario.pace
        step, interval = 1 / pace.simulation_frequency, 1 / pace.decision_frequency
        model = DrivingModel(pace.target_speeds, control.speed, step, interval, pace.detection_range, steady=steady)
        if isinstance(drivers, DriverMix):
            model = replace(model, human_braking=drivers.limit, human_acceleration=drivers.acceleration)
        self.driving_model = model if limits is None else limited_model(model, limits, drivers)
        self.road_map = road_map(scenario.road)
        profiles = self.road_map.speed_profiles(self.driving_model)
        self._network = build_network(scenario.road)
        self._route_paths = {
            route.id: route_path(self.road_map, route.id, profiles.get(route.id)) for route in scenario.road.routes
        }
        self._world: WorldState | None = None
        self._outcome: Outcome | None = None

    def reset(self, seed: int) -> WorldState:
        """Begin an episode.

        Raises:
            ScenarioError: If the vehicles cannot be placed.
        """
        self._world = self._outcome = None
        self._seed, step = seed, self.driving_model.step
        scene, newcomers = self._scene(seed)
        if self.flow is None:
            cavs = [start.id for start in scene.starts if start.kind is Kind.CAV]
            self._termination = Termination(cavs, self.scenario.pace.time_limit, step)
        else:
            self._termination, scene = Counting(self.flow, newcomers, step), replace(scene, starts=())
        self._traffic = self._populated(scene)
        lanes = {lane: self._network.get_lane(lane) for lane in entries(self.scenario)}
        self._outside = Outside(newcomers, lanes)
        self._steps = self._decisions = 0
        self._handed_over = False
        self._recorder = Recorder()
        self._recorder.record(0, self._traffic.vehicles, {})
        self._let_in()
        return self._look()

    def step(self, actions: Mapping[str, Action | ControlInput]) -> WorldState:
        """Let every CAV carry out its decision until the next one is due, or until the episode ends.

        Raises:
            EpisodeError: If no episode is going on, or an action is missing, of no CAV, not available, or not finite.
        """
        self._check(actions)
        for vehicle in self._traffic.vehicles:
            if isinstance(vehicle, ConnectedVehicle):
                vehicle.take(actions[vehicle.id])
        in_force = {name: str(action) for name, action in actions.items() if isinstance(action, Action)}
        for _ in range(self.driving_model.substeps):
            self._traffic.act()
            self._traffic.step(self.driving_model.step)
            self._steps += 1
            self._recorder.record(self._steps, self._traffic.vehicles, in_force)
            if self.observer is not None:
                seen = snapshot(self._traffic, self._time, self._decisions)
                self.observer(replace(seen, routes=human_routes(self._traffic)))
            self._outcome = self._termination.check(self._traffic, self._time)
            if self._outcome is not None:
                break
        else:
            self._let_in()
        self._decisions += 1
        return self._look()

    def _let_in(self) -> None:
        """Let vehicles of a flow come in."""
        there = len(self._traffic.vehicles)
        for start in self._outside.come_in(self._traffic, self._time):
            self._put(self._traffic, self._seed, (start,))
        self._take_over()
        self._recorder.record(self._steps, self._traffic.vehicles[there:], {})

    def alone(self, seed: int) -> Mapping[str, FloatArray]:
        """Drive each vehicle of an episode alone, from the same start along the same route."""
        model = self.driving_model
        time_limit = self.scenario.pace.time_limit if self.flow is None else LONGEST
        scene, _ = self._scene(seed)
        # Cells of other methods drive the same scenes in the same world.
        world = (scene, model, time_limit, self.control, self.drivers, self.corrections)
        key = (self.road_map, repr(world))
        if key not in _ALONE:
            while len(_ALONE) >= REMEMBERED:
                del _ALONE[next(iter(_ALONE))]
            _ALONE[key] = {
                start.id: drive_alone(
                    self._populated(replace(scene, starts=(start,))), model.step, model.substeps, time_limit
                )
                for start in scene.starts
            }
        return _ALONE[key]

    def _scene(self, seed: int) -> tuple[Scene, tuple[Newcomer, ...]]:
        """Return who takes part, and of a flow also who wants to come in when."""
        if self.flow is None:
            return self.scenario.scene(seed), ()
        newcomers = draw_newcomers(self.scenario, self.flow, seed, self.driving_model.decision_interval)
        return Scene(seed, tuple(newcomer.start for newcomer in newcomers)), newcomers

    def _populated(self, scene: Scene) -> Traffic:
        """Put the vehicles of a scene on the road."""
        rng = np.random.default_rng(np.random.SeedSequence(entropy=scene.seed, spawn_key=(1,)))
        styled = isinstance(self.drivers, DriverMix)
        traffic = Traffic(self._network, rng, self.road_map, self.corrections, styled)
        self._put(traffic, scene.seed, scene.starts)
        return traffic

    def _put(self, traffic: Traffic, seed: int, starts: tuple[Start, ...]) -> None:
        """Put vehicles on the road; in a flow a driver does not depend on who came before."""
        if self.flow is not None and starts:
            key = np.random.SeedSequence(entropy=seed, spawn_key=(1, *starts[0].id.encode()))
            traffic.np_random = np.random.default_rng(key)
        scene = Scene(seed, starts)
        spawn(traffic, scene, self._route_paths, self.driving_model.target_speeds, self.control, self.drivers)
        limit(traffic, self.limits)
        for vehicle in traffic.vehicles:
            if isinstance(vehicle, ConnectedVehicle):
                vehicle.may_hold = self.driving_model.steady

    def hand_over(self) -> WorldState:
        """Let all CAVs drive as attentive human drivers do; scene and human drivers stay as they are.

        Raises:
            EpisodeError: If no episode has just begun.
        """
        if self._world is None or self._decisions:
            raise EpisodeError("CAVs are handed over when an episode begins; call reset(seed) before hand_over()")
        self._handed_over = True
        self._take_over()
        return self._look()

    def _take_over(self) -> None:
        """Put a driver into each CAV that waits for decisions."""
        if self._handed_over:
            take_over(self._traffic, self.drivers, self.driving_model.top_speed)
            limit(self._traffic, self.limits)

    @property
    def outcome(self) -> Outcome | None:
        """How the episode ended; None while it goes on."""
        return self._outcome

    def trajectory(self) -> Trajectory:
        """Return what all vehicles have driven so far.

        Raises:
            EpisodeError: If no episode has begun.
        """
        if self._world is None:
            raise EpisodeError("no episode has begun; call reset(seed) before trajectory()")
        return self._recorder.trajectory(self.driving_model.step, self._termination.arrivals)

    def manners(self) -> Mapping[str, Manner]:
        """Return how each human driver on the road treats the right of way, by id."""
        return {v.id: v.manner for v in self._traffic.vehicles if v.kind is Kind.HDV}

    @property
    def lasting(self) -> tuple[object, ...]:
        """What no episode changes, so that copies of a world may share it."""
        lanes = self._network.lanes_list()
        return (self.road_map, self.driving_model, self.scenario, self._network, *lanes, *self._route_paths.values())

    def redraw_drivers(self, seed: int) -> None:
        """Let drivers drawn anew from the same mix go on where human drivers are now; nothing where none are drawn."""
        if isinstance(self.drivers, DriverMix):
            for vehicle in self._traffic.vehicles:
                if isinstance(vehicle, HumanDriver):
                    vehicle.become(self.drivers.draw(seed, vehicle.id))

    @property
    def _time(self) -> float:
        return round(self._steps * self.driving_model.step, 9)

    def _look(self) -> WorldState:
        self._world = snapshot(self._traffic, self._time, self._decisions)
        return self._world

    def _check(self, actions: Mapping[str, Action | ControlInput]) -> None:
        """Refuse actions that the CAVs on the road cannot carry out."""
        if self._world is None:
            raise EpisodeError("no episode has begun; call reset(seed) before step(actions)")
        if self._outcome is not None:
            raise EpisodeError("the episode is over; call reset(seed) before step(actions)")
        available = {name: known for name, known in self._world.available.items() if known}
        if set(actions) != set(available):
            raise EpisodeError(f"one action for each of {sorted(available)} is needed, got {sorted(actions)}")
        for name, action in actions.items():
            if isinstance(action, ControlInput):
                if not math.isfinite(action.acceleration + action.steering):
                    raise EpisodeError(f"the command of {name} must be finite numbers, got {action}")
            elif action not in available[name]:
                raise EpisodeError(f"{name} cannot do {action} here; it can do {', '.join(available[name])}")


def spawn(
    traffic: Traffic,
    scene: Scene,
    route_paths: Mapping[str, RoutePath],
    target_speeds: tuple[float, ...],
    control: ControlGains,
    drivers: DriverProfile | DriverMix,
) -> None:
    """Put all vehicles on the road, in the order of the scene."""
    corrections = traffic.corrections
    for start in scene.starts:
        if start.kind is Kind.CAV:
            cav = ConnectedVehicle.start(traffic, start, route_paths, target_speeds, control, corrections)
            traffic.vehicles.append(cav)
            continue
        traits = drivers.draw(scene.seed, start.id) if isinstance(drivers, DriverMix) else None
        traffic.vehicles.append(HumanDriver.start(traffic, start, route_paths, drivers, corrections, traits))


def limited_model(model: DrivingModel, limits: VehicleLimits, drivers: DriverProfile | DriverMix) -> DrivingModel:
    """Return what methods may know of vehicles that have limits; human drivers may keep below them."""
    braking, pedal = min(limits.braking, drivers.limit), min(limits.acceleration, drivers.limit, drivers.acceleration)
    return replace(model, limits=limits, human_braking=braking, human_acceleration=pedal)


def limit(traffic: Traffic, limits: VehicleLimits | None) -> None:
    """Give all vehicles the limits, and with them the gains with which they change lanes."""
    if limits is None:
        return
    gains = limits.change_gains(traffic.road_map.widest)
    for vehicle in traffic.vehicles:
        vehicle.limits, vehicle.change_gains = limits, gains
