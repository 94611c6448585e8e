"""A picture of a world while it is driven, as the ``render()`` of an environment wants it."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from codriving.animation.content import DrawnDecision, DrawnVehicle, FrameContent, deliberated
from codriving.animation.style import check_size
from codriving.datatypes import Action, Kind, Outcome, WorldState
from codriving.geometry import RoadMap

if TYPE_CHECKING:
    from codriving.animation.picture import Picture
    from codriving.animation.window import Window


class LivePicture:
    """Draws world states as they come; needs no display, and keeps what does not move between two frames.

    The same calls in the same order give the same pixels. Nothing heavy is imported before the first frame.

    Args:
        title: First line of the panel, for instance ``intersection, seed 3``.
        width: Width of a frame at scale 1 [px]; the panel takes 384 of it.
        height: Height of a frame at scale 1 [px].

    Raises:
        ConfigError: If a size is out of range.

    Example:
        >>> picture = LivePicture(environment.road_map, "intersection, seed 3")  # doctest: +SKIP
        >>> world = environment.reset(seed=3)  # doctest: +SKIP
        >>> frame = picture.draw(world)  # (720, 1280, 3), uint8  # doctest: +SKIP
        >>> world = environment.step(actions)  # doctest: +SKIP
        >>> frame = picture.draw(world, actions, outcome=environment.outcome)  # doctest: +SKIP
    """

    def __init__(
        self,
        road_map: RoadMap,
        title: str = "",
        width: int = 1280,
        height: int = 720,
        scale: float = 1.0,
        panel: bool = True,
    ) -> None:
        check_size(width, height, scale, panel)
        self._road_map, self._title, self._size, self._panel = road_map, title, (width, height, scale), panel
        self._time = np.inf
        self._picture: Picture | None = None
        self._windows: tuple[Window, ...] = ()

    def draw(
        self,
        world: WorldState,
        actions: Mapping[str, Action] | None = None,
        deliberation: Mapping[str, Any] | None = None,
        outcome: Outcome | None = None,
        arrivals: Mapping[str, float] | None = None,
        title: str | None = None,
    ) -> NDArray[np.uint8]:
        """Draw one frame.

        The view is chosen anew whenever time goes back, as after a reset.

        Args:
            deliberation: ``Deliberation.as_dict()`` of the method, if there is one: conflicts, order and reasons.
            arrivals: Arrival time of each CAV that has arrived [s], by id; without it a CAV that has left the road
                counts as arrived, and the outcome says when.

        Returns:
            The frame (height, width, 3), uint8, RGB; an array of its own that may be kept.
        """
        if title is not None and title != self._title:
            self._title, self._picture = title, None
        if self._picture is None or world.time < self._time:
            self._begin(world)
        self._time = world.time
        assert self._picture is not None
        decided = deliberated(deliberation, self._road_map) if deliberation else FrameContent(world.time)
        told = {name: DrawnDecision(Action(action)) for name, action in (actions or {}).items()}
        bodies = []
        for v in world.vehicles:
            intent = world.intents.get(v.id) if v.kind is Kind.CAV else None
            route = intent.route if intent else None
            bodies.append(DrawnVehicle(v.id, v.kind, v.x, v.y, v.heading, v.speed, route, v.length, v.width))
        arrived = arrivals if arrivals is not None else self._arrived(world, outcome)
        seen = replace(decided, time=world.time, bodies=tuple(bodies), thoughts={**told, **decided.thoughts})
        return self._picture.rgb(replace(seen, arrived=arrived, outcome=outcome), self._windows)

    def _begin(self, world: WorldState) -> None:
        """Choose a view from which the vehicles that are there and the places that they go to are seen."""
        from codriving.animation.camera import overview
        from codriving.animation.panel import natural
        from codriving.animation.picture import Picture

        cavs = tuple(sorted((vehicle.id for vehicle in world.cavs), key=natural))
        width, height, scale = self._size
        self._picture = Picture(self._road_map, cavs, (self._title, ""), width, height, scale, self._panel)
        places = [(v.x, v.y) for v in world.vehicles]
        for route in sorted({intent.route for intent in world.intents.values()} or set(self._road_map.routes)):
            x, y = self._road_map.paths[route].position(self._road_map.routes[route].goal)
            places.append((float(x), float(y)))
        self._windows = overview(np.array(places), self._road_map, self._picture.view)

    def _arrived(self, world: WorldState, outcome: Outcome | None) -> Mapping[str, float | None]:
        """CAVs leave the road by arriving; a collision ends the episode with all vehicles in place."""
        assert self._picture is not None
        here = {vehicle.id for vehicle in world.cavs}
        times: Mapping[str, float] = outcome.arrivals if outcome else {}
        return {name: times.get(name) for name in self._picture.cavs if name not in here}
