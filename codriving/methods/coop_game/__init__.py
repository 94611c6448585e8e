"""Coop game."""
