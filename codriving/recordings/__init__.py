"""Trajectories of others and for others: recordings are read, and what was driven is written in their layouts."""

from codriving.recordings.fcd import fcd_text
from codriving.recordings.interhub import interhub_rows
from codriving.recordings.read import read_recording
from codriving.recordings.tidy import tidy_text

__all__ = ["fcd_text", "interhub_rows", "read_recording", "tidy_text"]
