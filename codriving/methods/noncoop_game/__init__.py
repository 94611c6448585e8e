"""Noncoop game."""
