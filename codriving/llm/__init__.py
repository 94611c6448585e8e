"""Who reasons: the built-in rules, or a language model."""
