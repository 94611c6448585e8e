"""Seed to scene: the roads, the places where vehicles start and where they want to go."""
