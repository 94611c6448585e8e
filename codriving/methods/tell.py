"""TeLL: each CAV on its own, by a policy that learned with a teacher beside it (after Xu et al., 2025)."""

from pathlib import Path

from codriving.methods.learned.layout import JUNCTION
from codriving.methods.learned.learned import PROBABILITIES, Learned
from codriving.methods.learned.weights import load, shipped


class Tell(Learned):
    """A policy of a single vehicle that attends to others one by one; its teacher is not there any more.

    No model is asked while it drives, so the reasoner is ``none``; the variant names the teacher.
    """

    name = "tell"
    shared, meaning = False, PROBABILITIES

    def __init__(self, weights: Path | None) -> None:
        super().__init__(weights)
        file = shipped(self.name, JUNCTION, limited=True) if weights is None else weights
        teacher = str(load(file).purpose.training.get("teacher", "")) or "no teacher"
        self.variant = ", ".join(filter(None, [self.variant, f"taught by {teacher}"]))
