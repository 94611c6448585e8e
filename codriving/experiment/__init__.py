"""Config -> cells -> records: what every command drives."""

from codriving.experiment.as_in_paper import results_of
from codriving.experiment.asking import REPLAY, announce
from codriving.experiment.batch import Driven, Ended, Finished, HaltedError, Interrupted, Outputs, drive, driving
from codriving.experiment.cells import Cell, shown_apart, swept_values
from codriving.experiment.flows import is_flow
from codriving.experiment.joining import FoundPart, Joining, check_alike, find_parts
from codriving.experiment.objects import BuildWithGiven, make_objects, model_of
from codriving.experiment.plan import Plan, cell_name, composed, make_plan, refuse_flows, suite_of, validated
from codriving.experiment.remembering import learns, memory_file
from codriving.experiment.scoring import lacks, scorers_of
from codriving.experiment.shards import SHARD, refuse_nameless, refuse_part, without_shard
from codriving.experiment.stored import (
    StoredEpisode,
    all_episodes,
    find_episode,
    find_run,
    read_episode,
    read_film,
    road_of,
)

__all__ = [
    "REPLAY", "SHARD", "BuildWithGiven", "Cell", "Driven", "Ended", "Finished", "FoundPart", "HaltedError",
    "Interrupted", "Joining", "Outputs", "Plan", "StoredEpisode", "all_episodes", "announce", "cell_name",
    "check_alike", "composed", "drive", "driving", "find_episode", "find_parts", "find_run", "is_flow", "lacks",
    "learns", "make_objects", "make_plan", "memory_file", "model_of", "read_episode", "read_film", "refuse_flows",
    "refuse_nameless", "refuse_part", "results_of", "road_of", "scorers_of", "shown_apart", "suite_of",
    "swept_values", "validated", "without_shard",
]  # fmt: skip
