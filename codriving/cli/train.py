"""`codriving train`: a learner from nothing to weights."""

from typing import Annotated

import typer

from codriving.cli.arguments import ConfigDir


def train(
    learner: Annotated[str, typer.Argument(metavar="LEARNER", help="What is trained: madqn, ppo or tell.")],
    overrides: Annotated[
        list[str] | None,
        typer.Argument(metavar="[KEY=VALUE]...", help="Settings, for instance seed=2, decisions=300000 or run=second."),
    ] = None,
    family: Annotated[
        str, typer.Option("--family", help="Roads to train for: junction (intersection, roundabout) or lanes.")
    ] = "junction",
    smoke: Annotated[bool, typer.Option("--smoke", help="A test of the machinery in less than two minutes.")] = False,
    config_dir: ConfigDir = None,
) -> None:
    """Train a learner on the environment; the same command goes on where it was stopped.

    Needs PyTorch: pip install 'codriving[train]'. Config, curve, checkpoint and weights are kept in outputs/train/NAME.
    """
    from codriving.training.command import run_training

    raise typer.Exit(run_training(learner, family, overrides or [], smoke, config_dir))
