"""The run folder: files that are there whole or not at all, and are checked when they are read again."""

from codriving.runs.atomic import whole_file, whole_folder, write_text
from codriving.runs.continuation import changed_versions, difference
from codriving.runs.episode_folder import (
    EPISODES,
    UNNAMED,
    Timing,
    episode_folder,
    read_decisions,
    read_record,
    read_timing,
    read_transcript,
    timing_of,
    write_episode,
)
from codriving.runs.identity import (
    BEHAVIOUR,
    CHOICES,
    MEMORY,
    CellEntry,
    NamedFile,
    driving_values,
    files_of,
    fingerprint,
    same_cell,
    settings_of,
    snapshot_of,
)
from codriving.runs.intact import RECORD, TRAJECTORY, check_files, rewrite_record
from codriving.runs.manifest import FORMAT, MANIFEST, Manifest, only_old_world, read_manifest
from codriving.runs.parts import PART, PARTS, Part, Shard, read_part, write_part
from codriving.runs.provenance import commit, machine, source_digest, versions
from codriving.runs.redaction import MASK, flat, nested, redact, scrubbed, secrets_of, variables_in
from codriving.runs.run_folder import (
    RunFolder,
    checked_record,
    locked,
    new_run_path,
    removed,
    unwritable,
    within,
)
from codriving.runs.trajectory_file import read_trajectory

__all__ = [
    "BEHAVIOUR", "CHOICES", "EPISODES", "FORMAT", "MANIFEST", "MASK", "MEMORY", "PART", "PARTS", "RECORD",
    "TRAJECTORY", "UNNAMED", "CellEntry", "Manifest", "NamedFile", "Part", "RunFolder", "Shard", "Timing",
    "changed_versions", "check_files", "checked_record", "commit", "difference", "driving_values", "episode_folder",
    "files_of", "fingerprint", "flat", "locked", "machine", "nested", "new_run_path", "only_old_world",
    "read_decisions", "read_manifest", "read_part", "read_record", "read_timing", "read_trajectory", "read_transcript",
    "redact", "removed", "rewrite_record", "same_cell", "scrubbed", "secrets_of", "settings_of", "snapshot_of",
    "source_digest", "timing_of", "unwritable", "variables_in", "versions", "whole_file", "whole_folder", "within",
    "write_episode", "write_part", "write_text",
]  # fmt: skip
