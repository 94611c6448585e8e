"""The paper's reasoning module: share states, share intents, negotiate, check, decide."""
