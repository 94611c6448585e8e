"""Overrides to config to objects: the only door to Hydra and OmegaConf."""
