"""The nouns: frozen dataclasses that every room speaks in."""
