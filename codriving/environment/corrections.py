"""Which faults of highway-env 1.12 are corrected; each has a switch and a test."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Corrections:
    """One switch for every fault; all on in ``conf/config.yaml``.

    With every switch off a vehicle moves as highway-env's own classes do, bit for bit.

    Attributes:
        own_parameters: highway-env's intersection writes driver parameters into the class, for every later scenario of
            the process. On: they belong to the driver.
    """

    no_reverse: bool
    route_prediction: bool
    route_leader: bool
    route_lane: bool
    yield_at_entry: bool
    start_into_gap: bool
    connected_lanes: bool
    own_parameters: bool
    remove_at_sink: bool
    true_collisions: bool
