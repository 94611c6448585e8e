"""What the tables are made of: the episodes of a cell, what was measured of them, and what methods counted."""

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from codriving.datatypes import Ending, EpisodeRecord, NamedNumber, Score
from codriving.metrics import wilson_interval
from codriving.reports.columns import Column, Value, mean, share
from codriving.reports.decided import COUNTED, Decided

# The columns that every table begins with.
LABELS: tuple[Column[EpisodeRecord], ...] = (
    Column("scenario", lambda record: record.scenario, words=True),
    Column("method", lambda record: record.method, words=True),
    Column("variant", lambda record: record.variant, words=True),
    Column("reasoner", lambda record: record.reasoner, words=True),
)

COST = "cost_usd"

# Time that a decision step waited for the model, on average [s]; of a cached answer, the time that it took then.
SECONDS = "step_seconds"

# Counter of the time that was waited for the model [s]; it has no column but the mean of a step.
WAITED = "model_seconds"

# The columns of every table of a run in which a language model reasons, in their fixed order.
ASKED = (
    "model_calls",
    "prompt_tokens",
    "completion_tokens",
    COST,
    SECONDS,
    "re_asks",
    "mended",
    "fallbacks",
    "shortened",
    "repaired_orders",
    "plain_decisions",
    "kept_orders",
)

# Whose the decisions and the ordered pairs were, in their fixed order: columns where it was counted.
WHOSE = (
    *("model_decisions", "mended_decisions", "single_decisions", "fallback_decisions", "decisions_as_rules"),
    *("model_pairs", "mended_pairs", "repaired_pairs", "fallback_pairs", "pairs_as_rules"),
    *("cached_tokens", "reasoning_tokens", "cut_off", "withheld"),
)

UNPRICED = "unpriced_calls"  # Counter of calls whose price is not known; it has no column, it empties that of the cost


@dataclass(frozen=True)
class CellResults:
    """The episodes of one cell, which is one row of a table."""

    records: Sequence[EpisodeRecord]
    swept: Mapping[str, str] = field(default_factory=dict)
    # CPU time of a decision [s], or None where that is lost; it goes into no file that has to repeat.
    cpu: float | None = None
    metric: str = "standard"  # Name of the metric whose scores are shown
    # Whether the scenario is driven with the paper's vehicles, and whether also on as many seeds as its rows.
    papers_setting: bool = True
    as_in_paper: bool = True
    remark: str = ""  # What a reader of its numbers has to know of the method
    repeatable: bool = True  # Whether the same command gives the same numbers

    @property
    def first(self) -> EpisodeRecord:
        """A record that says of what scenario and method they are."""
        return self.records[0]

    @property
    def name(self) -> str:
        """The method, with its variant."""
        return f"{self.first.method} {self.first.variant}".strip()

    @property
    def is_control(self) -> bool:
        """Whether it is no method: its variant, or the name of its reasoner, says so with its first word."""
        said = self.first.variant.replace("/", " "), self.first.reasoner
        return any(text.split(" ")[0] == "control" for text in said)

    @cached_property
    def episodes(self) -> "list[ScoredEpisode]":
        """Each episode with its score."""
        return [ScoredEpisode(record, record.scores.get(self.metric), self.swept) for record in self.records]

    @cached_property
    def completed(self) -> "list[ScoredEpisode]":
        """The episodes that did not end in an error."""
        return [episode for episode in self.episodes if episode.record.outcome.ending is not Ending.ERROR]

    @cached_property
    def successes(self) -> "list[ScoredEpisode]":
        """The successful episodes."""
        return [episode for episode in self.completed if episode.success]

    @cached_property
    def interval(self) -> tuple[float | None, float | None]:
        """Wilson 95 % interval of the success rate over completed episodes."""
        return success_interval(len(self.successes), len(self.completed))

    @property
    def success(self) -> tuple[float | None, float | None, float | None]:
        """Rate of success over the completed episodes, and its Wilson 95 % interval."""
        return share(len(self.successes), len(self.completed)), *self.interval

    @cached_property
    def judged(self) -> "list[ScoredEpisode]":
        """The completed episodes of which it is known whether they are clean."""
        return [episode for episode in self.completed if episode.clean is not None]

    @cached_property
    def clean(self) -> tuple[float | None, float | None, float | None]:
        """Rate of clean success over the judged episodes, and its Wilson 95 % interval."""
        clean, judged = sum(bool(episode.clean) for episode in self.judged), len(self.judged)
        return share(clean, judged), *success_interval(clean, judged)

    @property
    def standing(self) -> tuple[float, float]:
        """By what it is ranked, the best first: clean success, then the mean time of all vehicles."""
        rate, time = self.clean[0], self.numbers.get("time_all")
        return (math.inf if rate is None else -rate), (math.inf if time is None else time)

    @cached_property
    def pets(self) -> list[float]:
        """All PETs of successful episodes [s]."""
        return [pet for episode in self.successes for pet in episode.pets]

    @cached_property
    def velocities(self) -> list[float]:
        """Mean velocity of every vehicle of successful episodes [m/s]."""
        return [velocity for episode in self.successes for velocity in episode.velocities]

    def rate(self, ending: Ending) -> float | None:
        """Give the rate of an ending over completed episodes."""
        return share(sum(episode.record.outcome.ending is ending for episode in self.completed), len(self.completed))

    @cached_property
    def collisions(self) -> Counter[str]:
        """How many collisions there were, by kinds of the two."""
        return Counter(c.pair for episode in self.completed if (c := episode.record.outcome.collision) is not None)

    @cached_property
    def numbers(self) -> dict[str, float | None]:
        """Mean of each further number of the metric, over the completed episodes in which it is defined."""
        values: dict[str, list[float]] = {}
        for name, value in (pair for episode in self.completed for pair in episode.numbers.items()):
            values.setdefault(name, []).extend([] if value is None else [value])
        return {name: mean(found) for name, found in values.items()}

    @cached_property
    def counters(self) -> dict[str, Value]:
        """What the method counted in all episodes, failed ones included: they have been paid for."""
        return counted(self.records)

    @cached_property
    def asked(self) -> bool:
        """Whether a language model was there to be asked."""
        return any(map(asked, self.records))

    @cached_property
    def decided(self) -> Decided | None:
        """Whose its decisions and pairs were; None where no model was asked, or that was not counted."""
        known = [r.counts for r in self.records if asked(r) and COUNTED in r.counts]
        return Decided.of(known) if known else None

    @property
    def fallback_rate(self) -> float | None:
        """Share of questions without a usable answer; each question counts once, however often it was asked."""
        counts = (int(self.counters.get(name) or 0) for name in ("model_calls", "re_asks", "shortened", "fallbacks"))
        calls, again, shortened, fallbacks = counts
        return share(fallbacks, max(calls - again - shortened, fallbacks)) if self.asked else None


def stored_results(records: Sequence[EpisodeRecord], swept: Mapping[str, str]) -> CellResults:
    """Give stored episodes of a cell, scored by the metric that is usual, or by the first one that there is."""
    names = list(dict.fromkeys(name for record in records for name in record.scores))
    metric = "standard" if "standard" in names or not names else names[0]
    return CellResults(records, swept, metric=metric, papers_setting=False, as_in_paper=False)


@dataclass(frozen=True)
class ScoredEpisode:
    """One episode by one metric."""

    record: EpisodeRecord
    score: Score | None  # None for an episode that ended in an error
    swept: Mapping[str, str] = field(default_factory=dict)

    @property
    def success(self) -> bool:
        """Whether it succeeded."""
        return self.score is not None and bool(self.score.success)

    @property
    def clean(self) -> bool | None:
        """Whether it is a success without a near miss; None where that is not known."""
        return self.score.clean if self.score else None

    @property
    def pets(self) -> list[float]:
        """All PETs [s]."""
        return [pet.value for pet in self.score.pets] if self.score else []

    @property
    def velocities(self) -> list[float]:
        """Mean velocity of every vehicle [m/s]."""
        return [travel.velocity for travel in self.score.travels] if self.score else []

    @property
    def times(self) -> list[float]:
        """Travel time of every vehicle [s]."""
        return [travel.time for travel in self.score.travels] if self.score else []

    @property
    def delays(self) -> list[float]:
        """Delay of every vehicle of which it is defined [s]."""
        return [travel.delay for travel in self.score.travels if travel.delay is not None] if self.score else []

    @property
    def numbers(self) -> dict[str, float | None]:
        """Further numbers of the metric by name."""
        return {number.name: number.value for number in self.score.numbers} if self.score else {}

    @cached_property
    def counters(self) -> dict[str, Value]:
        """What the method counted."""
        return counted([self.record])


def named_numbers(cells: Iterable[CellResults]) -> list[NamedNumber]:
    """List the further numbers of the metrics of some cells, each once."""
    scores = (episode.score for cell in cells for episode in cell.episodes if episode.score)
    return list({number.name: number for score in scores for number in score.numbers}.values())


def success_interval(successes: int, episodes: int) -> tuple[float | None, float | None]:
    """Give the Wilson 95 % interval of a success rate; of no episodes there is none."""
    return wilson_interval(successes, episodes) if episodes else (None, None)


def asked(record: EpisodeRecord) -> bool:
    """Tell whether a language model was there to be asked."""
    return not {"model_calls", COST}.isdisjoint(record.counts)


def counted(records: Sequence[EpisodeRecord]) -> dict[str, Value]:
    """Add up what was counted."""
    values: dict[str, list[int | float]] = {}
    for record in records:
        for name, number in record.counts.items():
            values.setdefault(name, []).append(number)
    # Exact summation makes the sum of amounts the same in any order.
    sums: dict[str, Value] = {
        name: math.fsum(numbers) if any(isinstance(number, float) for number in numbers) else sum(numbers)
        for name, numbers in values.items()
    }
    if any(map(asked, records)):
        sums = {**dict.fromkeys(ASKED, 0), COST: 0.0, **sums}
        if sums.pop(UNPRICED, 0):
            sums[COST] = None
        steps, waited = sum(record.decisions for record in records), sums.pop(WAITED, 0)
        sums[SECONDS] = float(waited or 0) / steps if steps else None
    return sums


def counter_names(records: Sequence[EpisodeRecord]) -> list[str]:
    """List the counters that have a column: those of a language model first, all others by name."""
    names = {name for record in records for name in record.counts} - {UNPRICED, WAITED}
    first = [name for name in ASKED if any(map(asked, records)) or name in names]
    first += [name for name in WHOSE if name in names]
    return [*first, *sorted(names.difference(first))]
