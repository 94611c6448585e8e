"""The memory: what CAVs did, what came of it, and what of that is like the situation at hand (paper Section III-D)."""
