"""A world whose scenes can be bounded: the environment, its envelope, and what is bounded."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from codriving.bound.envelope import Envelopes, file_name, load, text_of
from codriving.bound.measure import measure
from codriving.bound.meetings import Margins
from codriving.bound.passing import Passing
from codriving.bound.solve import Bound, lower_bound
from codriving.datatypes import Kind, Simulator, beside
from codriving.environment import Environment
from codriving.errors import ConfigError


@dataclass(frozen=True, slots=True, eq=False)
class BoundedWorld:
    """Bounds the scenes of one world; human drivers are left out."""

    environment: Environment
    envelopes: Envelopes | None  # None where CAVs choose their lanes: it is not known where their ways cross
    margins: Margins | None = None  # What an executor keeps, if only such executors are bounded
    one_order: bool = False  # Whether the executor keeps one order of vehicles at all zones

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self.environment.scenario.name

    @property
    def settings(self) -> str:
        """What the bounds depend on besides the config."""
        return f"{self.margins} {self.one_order} {text_of(self.envelopes) if self.envelopes else ''}"

    def solve(self, seed: int) -> Bound:
        """Bound the sum of arrivals of the CAVs of a seed; of CAVs that choose their lanes, by driving alone."""
        environment, model = self.environment, self.environment.driving_model
        if self.envelopes is not None:
            return lower_bound(self.cavs(seed), environment.road_map, model.step, self.margins, self.one_order)
        alone = environment.alone(seed)
        cavs = [start.id for start in environment.scenario.scene(seed).starts if start.kind is Kind.CAV]
        arrivals = {name: round((len(alone[name]) - 1) * model.step, 6) for name in cavs}
        total = round(sum(arrivals.values()), 6)
        return Bound(total, total, len(cavs), arrivals=arrivals)

    def cavs(self, seed: int) -> Sequence[Passing]:
        """Return what is known of each CAV of a seed."""
        environment, model = self.environment, self.environment.driving_model
        routes, alone, envelopes = environment.road_map.routes, environment.alone(seed), self.envelopes or {}
        return [
            Passing(s, routes[s.route], alone[s.id], envelopes[s.route], model.step, model.top_speed)
            for s in environment.scenario.scene(seed).starts
            if s.kind is Kind.CAV
        ]


def bounded_world(
    simulator: Simulator,
    folder: Path | None = None,
    margins: Margins | None = None,
    one_order: bool = False,
    may_measure: bool = False,
) -> BoundedWorld:
    """Find the envelope of an environment.

    Args:
        folder: Where envelopes are kept besides those of the package.
        may_measure: Whether one that is missing is measured, which takes minutes, and put into the folder.

    Raises:
        ConfigError: If no bound is defined in this world, or its envelope was never measured.
        OSError: If the folder cannot be written.
    """
    if not isinstance(simulator, Environment):
        raise ConfigError(f"bounds are those of Environment, and environment is a {type(simulator).__name__}")
    if simulator.flow is not None:
        raise ConfigError("no bound is defined for a flow, in which vehicles keep coming; leave flow= out")
    if getattr(simulator.scenario, "blocked_exit", 0):
        raise ConfigError(
            "no bound is defined at a blocked exit, where the least time depends on the vehicle that stands there; "
            "leave scenario.blocked_exit out"
        )
    lanes = [lane.id for lane in simulator.scenario.road.lanes]
    if any(beside(one, other) for one in lanes for other in lanes):
        if margins is not None:
            raise ConfigError(f"{simulator.scenario.name} has no margin bound, since CAVs choose their lanes there")
        return BoundedWorld(simulator, None)
    if may_measure and folder is not None:
        try:
            load(simulator, folder)
        except ConfigError:
            text = text_of(measure(simulator))
            folder.mkdir(parents=True, exist_ok=True)
            (folder / file_name(simulator)).write_text(text, encoding="utf-8")
    return BoundedWorld(simulator, load(simulator, folder), margins, one_order)
