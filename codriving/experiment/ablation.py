"""The ablation of the reasoning module: everything, and each sub-module removed (paper, ablation study)."""

from collections.abc import Sequence

from codriving.config.sweep import Point

OWN_ORDERS = ("own_view", "same_rule", "independent")
"""The readings of "each CAV generates its expected passing order"; all are reported, none is chosen afterwards."""

REMOVALS: tuple[tuple[str, ...], ...] = (
    (),
    ("cda.state_sharing=false",),
    ("cda.intent_sharing=false",),
    # An order that was not negotiated cannot bind.
    *(("cda.negotiation=false", "cda.binding=false", f"cda.own_order={order}") for order in OWN_ORDERS),
    ("cda.safety_check=false",),
)
"""What each cell of the ablation changes."""


def ablation_points(points: Sequence[Point]) -> list[Point]:
    """Take the sub-modules out of each config in turn.

    Returns:
        The cells, those of one config together and the full method first.
    """
    return [_without(point, removal) for point in points for removal in REMOVALS]


def _without(point: Point, removal: tuple[str, ...]) -> Point:
    named = any(override.lstrip("+").startswith("experiment=") for override in point.overrides)
    base = () if named else ("experiment=ablate",)
    return Point((*base, *point.overrides, *removal), point.swept, removal)
