"""Coop game fuzzy."""
