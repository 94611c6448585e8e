"""The memory: what CAVs did, what came of it, and what of that is like the situation at hand (paper Section III-D)."""

from codriving.memory.describe import describe
from codriving.memory.effect import LESSONS, DecisionHistory, HistoryStep, OwnCollision, effect_of, verdict_of
from codriving.memory.reading import Reading, own_embedder, read_memory, search
from codriving.memory.snapshot import StoredExperience
from codriving.memory.store import merge

__all__ = [
    "LESSONS", "DecisionHistory", "HistoryStep", "OwnCollision", "Reading", "StoredExperience", "describe",
    "effect_of", "merge", "own_embedder", "read_memory", "search", "verdict_of",
]  # fmt: skip
