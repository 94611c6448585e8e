"""`codriving compare orders`: one method with each passing order, so that nothing but the order varies."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

from codriving.config import Point, check_choice, choices, compose, expand, find_class, parse, target_of
from codriving.datatypes import OrderOfCavs
from codriving.experiment import is_flow
from codriving.reports import REFERENCE, Compared, Subject

ORDER, NEGOTIATED = "order", "negotiated"  # The key that varies, and the choice that all others are set against

SHARED = (
    f"One thing varies between the rows of {REFERENCE}: by which rule CAVs pass in what order ({ORDER}=). Perception, "
    "expected motion, safety check, memory, decision and all margins are the same in all of them.",
    "Each order binds as much as the negotiated one, and its schedule tells who goes first, a CAV or a human driver.",
)
OTHERS = "Rows of other methods differ in more than the order: in what makes actions of it, or in all."


def order_points(
    base: Sequence[str], overrides: Sequence[str], methods: Sequence[str], config_dir: Path | None
) -> list[Point]:
    """Give the cells: the reference with each order, then the methods that the user adds.

    Args:
        base: Tokens that come first.
        overrides: What the user typed, ``method=`` apart; ``order=`` adds orders.
    """
    keys = [parse(token).key_or_group for token in overrides]
    own = [token for token, key in zip(overrides, keys, strict=True) if key == ORDER]
    added = [point.overrides[0].partition("=")[2] for token in own for point in expand([token], config_dir)]
    for name in added:
        check_choice(ORDER, name, config_dir)
    points = []
    for point in expand([t for t, key in zip(overrides, keys, strict=True) if key != ORDER], config_dir):
        cavs = _most_cavs([*base, *point.overrides], config_dir)
        fit = [n for n in choices(ORDER) if (most := _orders(n)) is None or (cavs is not None and cavs <= most)]
        rows = [*((REFERENCE, f"{ORDER}={name}") for name in dict.fromkeys([*fit, *added]))]
        for method, *order in [*rows, *((name,) for name in methods if name != REFERENCE)]:
            swept = {**point.swept, "method": method, ORDER: "".join(order).partition("=")[2]}
            points.append(Point((*base, *point.overrides, *order, f"method={method}"), swept, point.removed))
    return points


def _most_cavs(overrides: Sequence[str], config_dir: Path | None) -> int | None:
    """Return how many CAVs there are at most; None in a flow, where there may be any number."""
    resolved = compose(overrides, config_dir)
    return None if is_flow(resolved) else int(resolved["scenario"].get("cavs", 0))


@cache
def _orders(name: str) -> int | None:
    """Return how many CAVs one of our rules orders at most; None for any number."""
    target = target_of(choices(ORDER)[name])
    rule = OrderOfCavs if target is None else find_class(target, ORDER, ())
    return rule.most_cavs if issubclass(rule, OrderOfCavs) else None


def as_orders(rows: Sequence[Compared]) -> list[Compared]:
    """Name the rows of the reference by their order, the negotiated one too."""
    found = []
    for row in rows:
        words = row.cell.first.variant.split("/") if row.cell and row.method == REFERENCE else []
        if words and not any(word.startswith(f"{ORDER}=") for word in words):
            words = [*(word for word in words if word != "full"), f"{ORDER}={NEGOTIATED}"]
            row = replace(row, label=f"{row.method} {'/'.join(words)}")
        found.append(row)
    return found


def subject_of(rows: Sequence[Compared]) -> Subject:
    """Say what the rows differ in."""
    orders = {word for row in rows if row.cell for word in row.cell.first.variant.split("/")}
    few = [name for name in choices(ORDER) if _orders(name) is not None and f"{ORDER}={name}" not in orders]
    notes = (
        *SHARED,
        *([OTHERS] if any(row.method != REFERENCE for row in rows) else []),
        *(f"Left out: {ORDER}={name}, which orders at most {_orders(name)} CAVs." for name in few),
    )
    return Subject("passing orders", "order", f"{ORDER}={NEGOTIATED}", notes)
