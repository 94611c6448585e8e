"""``comparison.csv``: one row a method and scenario, missing methods included, each against codriving."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.model_columns import FALLBACK_RATE
from codriving.reports.pairs import PAIRED, better_in, paired, worse_in
from codriving.reports.paper import Paper
from codriving.reports.rows import Row
from codriving.reports.stand_in import STANDS_IN
from codriving.reports.summary import summary_row

REFERENCE = "codriving"
"""The method that all others are compared with."""

DRIVEN, MISSING, QUOTED_ALONE = "driven", "not there yet", "only in the paper"
"""Whether a method could be driven; the last for one that goes by a language model, where rules stood in for it."""

GUIDED = ("dilu", "tell")
"""Methods that go by a language model; with rules in its place they are not set beside the paper's numbers."""

MEASURED = (
    "episodes",
    "completed",
    "success_rate",
    "success_low",
    "success_high",
    "pet_mean",
    "pet_max",
    "pet_min",
    "pet_below_1_5",
    "velocity_mean",
    "velocity_max",
    "velocity_min",
)

QUOTED = ("success_rate", "pet_mean", "pet_max", "pet_min", "velocity_mean", "velocity_max", "velocity_min")

METHOD_CHOICE = "method_choice"
"""The swept key that two methods of one name are told apart by; it belongs to a row, all others to a block."""

TEXT = frozenset({"scenario", "method", "variant", "reasoner", "status", "better_in", "worse_in"})
"""Columns of words; all others are numbers."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One cell that is compared.

    Attributes:
        cpu: CPU time of a decision [s], or None where that is lost; it goes into no file that has to repeat.
    """

    records: Sequence[EpisodeRecord]
    swept: Mapping[str, str] = field(default_factory=dict)
    cpu: float | None = None

    @property
    def setting(self) -> Mapping[str, str]:
        """The swept keys that it shares with all cells of its block."""
        return {key: value for key, value in self.swept.items() if key != METHOD_CHOICE}

    @property
    def method(self) -> str:
        """What the method calls itself."""
        return self.records[0].method


@dataclass(frozen=True, slots=True)
class Compared:
    """One row of the comparison.

    Attributes:
        cpu: CPU time of a decision [s], or None.
    """

    row: Row
    cpu: float | None = None


def comparison_columns(swept: Sequence[str] = (), model: bool = False) -> tuple[str, ...]:
    """Give the columns of ``comparison.csv``."""
    quoted = (f"paper_{name}" for name in QUOTED)
    labels = ("scenario", "method", "variant", "reasoner", "status")
    asked = (FALLBACK_RATE,) if model else ()
    return (*labels, *swept, *MEASURED, *asked, *PAIRED, "better_in", "worse_in", *quoted)


def comparison_rows(block: Sequence[Entry], methods: Sequence[str], paper: Paper) -> list[Compared]:
    """Compare the methods of one block: cells on the same seeds that differ in the method alone.

    Returns:
        The rows: ``methods`` in their order, then all others as they come.
    """
    reference = next((entry for entry in block if entry.method == REFERENCE), None)
    rows: list[Compared] = []
    for method in methods:
        found = [_row(entry, reference, paper) for entry in block if takes_place_of(entry.method) == method]
        rows += found or [_without(block[0], method, paper, MISSING)]
        quoted = any(f"paper_{QUOTED[0]}" in compared.row for compared in found)
        if found and not quoted and method in GUIDED and _quoted(paper, block[0].records[0].scenario, method, ""):
            rows.append(_without(block[0], method, paper, QUOTED_ALONE))
    return rows + [_row(entry, reference, paper) for entry in block if takes_place_of(entry.method) not in methods]


def takes_place_of(name: str) -> str:
    """Return the method whose place in a table something takes, by what it calls itself."""
    return STANDS_IN.get(name, name)


def _row(entry: Entry, reference: Entry | None, paper: Paper) -> Compared:
    summary = summary_row(entry.records)
    against: Row = {}
    if reference is not None and entry is not reference:
        against = paired(entry.records, reference.records)
        against = {**against, "better_in": " ".join(better_in(against)), "worse_in": " ".join(worse_in(against))}
    row = {
        **{name: summary[name] for name in ("scenario", "method", "variant", "reasoner", *MEASURED)},
        **{name: summary[name] for name in (FALLBACK_RATE,) if name in summary},
        "status": DRIVEN,
        **entry.swept,
        **against,
        **_quoted(paper, str(summary["scenario"]), str(summary["method"]), str(summary["variant"])),
    }
    return Compared(row, entry.cpu)


def _without(beside: Entry, method: str, paper: Paper, status: str) -> Compared:
    scenario = beside.records[0].scenario
    row = {"scenario": scenario, "method": method, "status": status, **beside.setting}
    return Compared({**row, **_quoted(paper, scenario, method, "")})


def _quoted(paper: Paper, scenario: str, method: str, variant: str) -> Row:
    found = paper.row(scenario, method, variant)
    return {f"paper_{name}": found.numbers.get(name) for name in QUOTED} if found else {}


def swept_keys(entries: Iterable[Entry]) -> tuple[str, ...]:
    """List the swept keys that need a column, in their order."""
    return tuple(dict.fromkeys(key for entry in entries for key in entry.swept))
