"""`codriving export --to sft`: what was decided in a run, as lines of chats for fine-tuning elsewhere."""

import json
from collections.abc import Iterator, Sequence
from typing import Any

from codriving.commands.memory_build import TABLE_SEEDS
from codriving.datatypes import EpisodeRecord
from codriving.errors import RunFolderError
from codriving.exam import FIRST, LAST, SEEDS, of_decisions, of_transcript
from codriving.experiment import StoredEpisode
from codriving.runs import read_decisions, read_transcript

FILE = "sft.jsonl"


def refuse_measured(episodes: Sequence[StoredEpisode]) -> None:
    """Refuse seeds by which models are compared: one that has learnt from them cannot be measured on them.

    Raises:
        RunFolderError: With the first of them.
    """
    for seeds, what in (
        *((seeds, "tables are made with") for seeds in TABLE_SEEDS),
        (range(FIRST, LAST + 1), "the exam is of"),
        (SEEDS, "the judged moments are of"),
    ):
        if found := [episode.seed for episode in episodes if episode.seed in seeds]:
            raise RunFolderError(
                f"seed {found[0]} is one of {seeds.start} to {seeds.stop - 1}, which {what}: a model that is tuned on "
                "them cannot be measured any more; drive other seeds, for instance seed=1000000"
            )


def sft_text(driven: Sequence[tuple[StoredEpisode, EpisodeRecord]]) -> str:
    """Write a line for each decision and each order of a model, or for each decision of any other method.

    Raises:
        RunFolderError: If nothing can be written.
    """
    lines = [json.dumps(line, ensure_ascii=False) for one in driven for line in _lines(*one)]
    if not lines:
        raise RunFolderError(
            "no decision of these episodes says what the CAV knew, so there is no question to write; export a run of "
            "method=codriving, or of a method that orders"
        )
    return "".join(f"{line}\n" for line in lines)


def _lines(episode: StoredEpisode, record: EpisodeRecord) -> Iterator[dict[str, Any]]:
    asked = read_transcript(episode.folder)
    chats = of_transcript(asked) if asked else of_decisions(read_decisions(episode.folder))
    by = record.reasoner if record.reasoner not in ("rules", "none") else record.method
    for chat in chats:
        yield {**chat, "scenario": record.scenario, "seed": record.seed, "answered_by": by}
