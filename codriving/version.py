"""The version of the program, for packaging, manifests and messages alike."""

__version__ = "0.2.0"
