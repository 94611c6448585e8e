"""Which faults of highway-env 1.12 are corrected; each has a switch and a test."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Corrections:
    """One switch for every fault; all on in ``conf/config.yaml``.

    With every switch off a vehicle moves as highway-env's own classes do, bit for bit.

    Attributes:
        no_reverse: IDM has no floor at zero speed, so drivers roll backwards. On: nobody does.
        route_prediction: The constant-speed prediction mixes arc lengths of two lanes near a lane end, so the regulated
            road yields to ghosts. On: predictions run along it.
        route_leader: IDM sees only its own lane, so drivers are blind past a lane end. On: the leader is the nearest
            body on the driver's route, also one that crosses it.
        route_lane: A vehicle counts as being on whichever lane of the whole network is closest, inside a junction also
            on one that it only crosses. On: on the lane of its own route.
        yield_at_entry: Drivers who are told to yield freeze in the middle of the junction. On: they wait at its entry.
        start_into_gap: A driver who stops at the end of a ramp stays for ever. On: it may start into a gap.
        connected_lanes: Neighbours are looked for by lane number past a lane end. On: on the lane that is physically
            connected.
        own_parameters: highway-env's intersection writes driver parameters into the class, for every later scenario of
            the process. On: they belong to the driver.
        remove_at_sink: A car at the end of its route turns round or runs off. On: it leaves 8 m before the end.
        true_collisions: Collisions are declared from predicted overlaps, and push the cars apart. On: a collision is an
            overlap of the two footprints.
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
