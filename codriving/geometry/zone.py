"""A conflict zone: where two routes meet, and how far the first must be before the second may follow."""

from dataclasses import dataclass

from numpy.typing import ArrayLike

from codriving.datatypes.conflict import Relation
from codriving.geometry.band import Band, FollowingBand
from codriving.geometry.box import Footprint
from codriving.geometry.curve import FloatArray
from codriving.geometry.path import Path


@dataclass(frozen=True, slots=True, eq=False)
class ConflictZone:
    """One connected zone of the collision set of two routes, seen from route i.

    Attributes:
        entry_i: Arc length on route i at which the zone begins [m].
        exit_i: Arc length on route i at which the zone ends [m].
        entry_j: Arc length on route j at which the zone begins [m].
        exit_j: Arc length on route j at which the zone ends [m].
        point_i: Conflict point on route i, where the centre lines are closest [m].
        point_j: Conflict point on route j [m].
        merge_i: Where the centre lines begin to coincide on route i [m]; None unless converging or weaving.
        merge_j: The same on route j [m].
        split_i: Where they stop to coincide on route i [m]; None unless diverging or weaving.
        split_j: The same on route j [m].
    """

    relation: Relation
    entry_i: float
    exit_i: float
    entry_j: float
    exit_j: float
    point_i: float
    point_j: float
    merge_i: float | None
    merge_j: float | None
    split_i: float | None
    split_j: float | None
    over_i: Band | FollowingBand
    over_j: Band | FollowingBand

    def front(self, s_j: ArrayLike) -> FloatArray:
        """Return the front function: j may be at s_j only while s_i is greater [m], if i goes first.

        Args:
            s_j: Arc length of j on its route, a number or an array [m].

        Returns:
            Arc length on route i, in the shape of `s_j` [m]; -inf where j is outside the zone.
        """
        return self.over_j.highest(s_j)

    def back(self, s_j: ArrayLike) -> FloatArray:
        """Return the back function: j may be at s_j only while s_i is smaller [m], if i goes second.

        Args:
            s_j: Arc length of j on its route, a number or an array [m].

        Returns:
            Arc length on route i, in the shape of `s_j` [m]; +inf where j is outside the zone.
        """
        return self.over_j.lowest(s_j)

    def blocked(self, s_j: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return `back` and `front` [m] in one go.

        Args:
            s_j: Arc length of j on its route, a number or an array [m].
        """
        return self.over_j.blocked(s_j)

    def mirrored(self) -> "ConflictZone":
        """Return the same zone seen from route j."""
        return ConflictZone(
            relation=self.relation,
            entry_i=self.entry_j,
            exit_i=self.exit_j,
            entry_j=self.entry_i,
            exit_j=self.exit_i,
            point_i=self.point_j,
            point_j=self.point_i,
            merge_i=self.merge_j,
            merge_j=self.merge_i,
            split_i=self.split_j,
            split_j=self.split_i,
            over_i=self.over_j,
            over_j=self.over_i,
        )


def following_zone(path: Path, footprint: Footprint) -> ConflictZone:
    """Return the zone of two vehicles on the same route, who keep a body length apart all along.

    Args:
        footprint: Size of both vehicles [m].
    """
    band = FollowingBand(footprint.length)
    return ConflictZone(
        Relation.FOLLOWING, 0.0, path.length, 0.0, path.length, 0.0, 0.0, None, None, None, None, band, band
    )
