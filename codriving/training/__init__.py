"""Training of learned drivers, on the environment for agents; PyTorch is imported only while it goes on."""

from codriving.training.command import run_training

__all__ = ["run_training"]
