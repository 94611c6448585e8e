"""DiLu: describe, recall, reason, decode and reflect, each CAV on its own (after Wen et al., 2024)."""
