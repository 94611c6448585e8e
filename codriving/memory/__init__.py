"""The memory: what CAVs did and what came of it, and recall of that in similar situations (paper Section III-D)."""

from codriving.memory.describe import describe
from codriving.memory.effect import LESSONS, DecisionHistory, HistoryStep, OwnCollision, effect_of, verdict_of
from codriving.memory.lessons import is_placeholder, reflection_view
from codriving.memory.reading import Reading, own_embedder, read_memory, search
from codriving.memory.snapshot import StoredExperience
from codriving.memory.store import merge

__all__ = [
    "LESSONS", "DecisionHistory", "HistoryStep", "OwnCollision", "Reading", "StoredExperience", "describe",
    "effect_of", "is_placeholder", "merge", "own_embedder", "read_memory", "reflection_view", "search", "verdict_of",
]  # fmt: skip
