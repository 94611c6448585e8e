"""Idfst."""
