"""`codriving compare`: the paper's comparison tables."""

from typing import Annotated

import typer

from codriving.cli.arguments import Overrides
from codriving.errors import UserError


def compare(
    table: Annotated[str, typer.Argument(metavar="TABLE", help="Which table; baselines is planned.")] = "baselines",
    overrides: Overrides = None,
) -> None:
    """Compare methods on the same seeds (not there yet: codriving is the only method)."""
    raise UserError(
        f"compare {table} is not there yet: the comparison methods come in a later release; "
        "codriving run drives the only method so far, codriving ablate compares its variants"
    )
