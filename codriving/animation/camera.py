"""Where to look: on a compact road ever closer to where the CAVs are; a long one lies there as a whole, in rows."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from codriving.animation.window import Area, Window, bounds, rows
from codriving.datatypes import Kind, Track, Trajectory
from codriving.geometry import RoadMap, lane_path

CLOSEST = 8.0  # The view of a compact road is never closer than so many pixels a metre

MARGIN = 9.0  # Around what has to be seen [m]

_ROW_MARGIN = 6.0  # The same around lanes in rows: half a lane, and room for names [m]

_LONG = 4.0  # A road that is so many times as long as it is wide may be cut into rows; a junction never is

# If all come from one side up to the middle of the shared part, the world is about half as large around that.
_NEAR = 0.45

_EVERY = 0.1  # Time between two places of the camera [s]

_CALM = 1.6  # How slowly the camera moves: width of the bell by which its way is smoothed [s]


class Camera:
    """Keeps the CAVs of an episode in view.

    On a compact road it stays over the middle and moves in and out alone, so that the picture stays easy to follow.
    """

    def __init__(self, trajectory: Trajectory, road_map: RoadMap, view: Area) -> None:
        tracks = [t for t in trajectory.tracks if t.kind is Kind.CAV] or list(trajectory.tracks)
        self.still = overview(np.concatenate([np.column_stack((t.x, t.y)) for t in tracks]), road_map, view)
        self._zooms = _zooms(tracks, trajectory.step, self.still[0]) if len(self.still) == 1 else None

    def at(self, time: float) -> tuple[Window, ...]:
        """Return what is seen at a moment."""
        if self._zooms is None:
            return self.still
        return (replace(self.still[0], zoom=float(np.interp(time / _EVERY, np.arange(len(self._zooms)), self._zooms))),)


def overview(points: NDArray[np.float64], road_map: RoadMap, view: Area) -> tuple[Window, ...]:
    """Return windows through which points of the world are seen, in one view or in rows."""
    lanes = np.concatenate([lane_path(lane, spacing=5.0).points for lane in road_map.road.lanes])
    whole, box = bounds(lanes), bounds(points)
    if max(whole.width, whole.height) < _LONG * min(whole.width, whole.height):
        return (_around(points, road_map, view),)
    # A row shows the whole width of the road, also lanes without vehicles.
    along, low, long = (1, box.top, box.height) if whole.height > whole.width else (0, box.left, box.width)
    there = lanes[(lanes[:, along] >= low) & (lanes[:, along] <= low + long)]
    windows = rows(bounds(np.concatenate((points, there))).padded(_ROW_MARGIN), view)
    return windows if len(windows) > 1 else (_around(points, road_map, view),)


def _around(points: NDArray[np.float64], road_map: RoadMap, view: Area) -> Window:
    """The window that looks at points from the middle of the shared part of the road, where its routes enter it."""
    entries = [road_map.paths[route.id].position(route.entry) for route in road_map.road.routes]
    # Rounded, so that what mirrors on the road does so in the pixels.
    places = [tuple(round(v, 3) for v in bounds(p).centre) for p in (np.array(entries, dtype=float), points)]
    shared, own = (Window(view, x, y, fitting(points, x, y, view)) for x, y in places)
    # Where no vehicle comes near it, most of the frame would be land.
    return shared if shared.zoom > _NEAR * own.zoom else own


def fitting(points: NDArray[np.float64], x: float, y: float, view: Area) -> float:
    """Return how large the world may be shown around a place so that points are seen [px/m]."""
    far_x, far_y = np.abs(points - (x, y)).max(0) + MARGIN
    return float(min(view.width / 2 / far_x, view.height / 2 / far_y, CLOSEST))


def _zooms(tracks: list[Track], step: float, window: Window) -> NDArray[np.float64]:
    """How large the world is shown every tenth of a second (n,) [px/m]."""
    wanted = np.full(round(max(t.first_step + len(t.x) - 1 for t in tracks) * step / _EVERY) + 1, np.nan)
    for k in range(len(wanted)):
        rows_now = [(t, round(k * _EVERY / step) - t.first_step) for t in tracks]
        points = [(t.x[row], t.y[row]) for t, row in rows_now if 0 <= row < len(t.x)]
        if points:
            wanted[k] = fitting(np.array(points), window.x, window.y, window.area)
        elif k:
            wanted[k] = wanted[k - 1]
    wanted = np.nan_to_num(wanted, nan=window.zoom)
    # What will be seen soon is made room for in time: the smallest of what is near, then smoothed.
    reach = round(2 * _CALM / _EVERY)
    near = np.lib.stride_tricks.sliding_window_view(np.pad(wanted, 2 * reach, mode="edge"), 2 * reach + 1).min(1)
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) * _EVERY / _CALM) ** 2)
    return np.convolve(near, bell / bell.sum(), mode="valid")
