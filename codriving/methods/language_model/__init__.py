"""Coordinator and deciders that ask a language model, with the rules as fallback."""
