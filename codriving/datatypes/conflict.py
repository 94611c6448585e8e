"""Who meets whom, where and how badly (paper Section III-C, Eq. 3)."""

from dataclasses import dataclass
from enum import StrEnum


class Relation(StrEnum):
    """How two routes meet."""

    CROSSING = "crossing"
    CONVERGING = "converging"
    DIVERGING = "diverging"
    FOLLOWING = "following"
    WEAVING = "weaving"


class Severity(StrEnum):
    """The paper's four bands of the time difference to the conflict point."""

    SERIOUS = "serious danger"
    GENERAL = "general danger"
    SLIGHT = "slight danger"
    NONE = "no danger"


@dataclass(frozen=True, slots=True)
class Conflict:
    """Two vehicles whose ways ahead share a zone, seen from one of them."""

    ego: str
    other: str
    relation: Relation
    routes: tuple[str, str]
    zone: int
    places: tuple[float, float]  # Arc length of each along its route [m]
    distances: tuple[float, float]  # Distance of each to the zone [m]; 0 inside it
    exits: tuple[float, float]  # Distance of each to the end of the zone [m]
    ttcp: tuple[float, float]  # Time of each to the conflict zone at its present speed [s]
    dttcp: float  # Difference of the two times [s]
    severity: Severity  # The paper's band of ``dttcp``
    certain: bool
