"""Environment for learners -> trained weights. The only room that imports PyTorch, and only while it trains."""

from codriving.training.command import run_training

__all__ = ["run_training"]
