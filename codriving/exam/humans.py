"""Whether a human driver lets a CAV pass that goes on: the world is copied and asked."""

from codriving.datatypes import Action, Role
from codriving.environment import Environment
from codriving.exam.driving_on import Copied
from codriving.exam.observed import notebook_of
from codriving.geometry import progress
from codriving.judgement import Contest, entries, let_pass

LONGEST = 10.0  # How long the CAV goes on [s]
CLEARS = 2.0  # How long after it has come to the zone a collision says that it was not let pass [s]
ROOM = (4.0, 1.5)  # Distance [m] and time [s] to the vehicle ahead below which it does as the rules do


def lets_pass(copied: Copied, contest: Contest) -> bool | None:
    """Let a CAV go on, and see who of both comes first, the driver being who it is; None if neither comes there."""
    environment, method = copied.copy(copied.continuations[0])
    world, notebook, began = copied.world, notebook_of(method), copied.world.time
    first, passed = None, 0.0
    while environment.outcome is None and world.time < began + LONGEST:
        notebook.empty()
        actions = method.act(world).actions
        scene = next((s.scene for s, _ in notebook.situations if s.scene.ego.id == contest.cav), None)
        ahead = scene.next_in(Role.LEADING) if scene is not None else None
        near = scene is not None and ahead is not None and (ahead.gap or 0.0) <= ROOM[0] + ROOM[1] * scene.ego.speed
        if contest.cav in actions and not near:
            actions = {**actions, contest.cav: Action.FASTER}
        world = environment.step(actions)
        if first is None:
            first, passed = came_first(environment, contest, began), world.time
        if first is False or contest.cav not in actions or (first and world.time > passed + CLEARS):
            break
    outcome = environment.outcome
    if outcome is not None and {contest.cav, contest.human} <= set(outcome.failed):
        return False  # It did not let it pass
    return first


def came_first(environment: Environment, contest: Contest, began: float) -> bool | None:
    """Whether the CAV was at their next zone before the driver; None if neither was yet, True if they do not meet."""
    trajectory, road_map = environment.trajectory(), environment.road_map
    tracks = {track.id: track for track in trajectory.tracks if track.id in (contest.cav, contest.human)}
    places = {name: progress(road_map.paths[t.route], t.x, t.y, t.heading) for name, t in tracks.items()}
    entered = entries(tracks[contest.cav], tracks[contest.human], places, road_map, trajectory.step)
    return let_pass(entered, began) if any(min(both) > began for both in entered) else True
