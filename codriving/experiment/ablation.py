"""The ablation of the reasoning module: everything, and each sub-module removed (paper, ablation study)."""

from collections.abc import Sequence

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


def ablation_variations(overrides: Sequence[str]) -> list[list[str]]:
    """Give the overrides of each cell of the ablation.

    Args:
        overrides: What the user gave; it holds for every cell.

    Returns:
        The full method first.
    """
    named = any(override.lstrip("+").startswith("experiment=") for override in overrides)
    base = [*([] if named else ["experiment=ablate"]), *overrides]
    return [[*base, *removal] for removal in REMOVALS]
