"""One method against codriving on the same seeds: where which succeeds, and how far apart they are where both do."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from codriving.datatypes import Ending
from codriving.metrics import FEWEST, mcnemar, mean_interval
from codriving.reports.columns import Column, Value, mean
from codriving.reports.results import CellResults, ScoredEpisode
from codriving.reports.wording import signed

SIGNIFICANT = 0.05  # A p-value below this counts as a difference

AGAINST = "against codriving"


@dataclass(frozen=True)
class Difference:
    """The method minus codriving, over the seeds on which both succeed and have such a number."""

    pairs: int
    mean: float | None  # Mean difference, or None of no seed
    low: float | None  # Lower limit of its 95 % bootstrap interval; None of too few seeds
    high: float | None  # Upper limit

    def shown(self, sign: int) -> bool:
        """Tell whether the whole interval is above (1) or below (-1) zero."""
        return self.low is not None and self.high is not None and self.low * sign > 0 and self.high * sign > 0

    def __str__(self) -> str:
        middle = signed(self.mean) or "-"
        return middle if self.low is None else f"{middle} ({signed(self.low)} to {signed(self.high)})"


@dataclass(frozen=True)
class PairedRate:
    """On how many seeds either of two methods has what the other has not."""

    pairs: int
    gained: int  # The method alone
    lost: int  # codriving alone

    @classmethod
    def of(cls, pairs: Sequence[tuple[object, object]]) -> "PairedRate":
        """Count the pairs."""
        return cls(len(pairs), sum(bool(a and not b) for a, b in pairs), sum(bool(b and not a) for a, b in pairs))

    @property
    def difference(self) -> float | None:
        """Difference of the rates."""
        return (self.gained - self.lost) / self.pairs if self.pairs else None

    @cached_property
    def p(self) -> float | None:
        """p-value of the exact McNemar test."""
        return mcnemar(self.gained, self.lost) if self.pairs else None

    def shown(self, sign: int) -> bool:
        """Tell whether the method is shown to be better (1) or worse (-1)."""
        return self.p is not None and self.p < SIGNIFICANT and (self.gained - self.lost) * sign > 0


@dataclass(frozen=True)
class PairedCells:
    """The episodes of a method and those of codriving; pairs of which one ended in an error are left out."""

    cell: CellResults
    reference: CellResults

    @cached_property
    def driven(self) -> list[tuple[ScoredEpisode, ScoredEpisode]]:
        """Both episodes of each seed that both drove to an end."""
        by_seed = {episode.record.seed: episode for episode in self.reference.episodes}
        pairs = [(one, by_seed[one.record.seed]) for one in self.cell.episodes if one.record.seed in by_seed]
        return [(a, b) for a, b in pairs if Ending.ERROR not in (a.record.outcome.ending, b.record.outcome.ending)]

    @cached_property
    def success(self) -> "PairedRate":
        """Which of them succeeds."""
        return PairedRate.of([(a.success, b.success) for a, b in self.driven])

    @cached_property
    def clean(self) -> "PairedRate":
        """Which of them succeeds without a near miss, where that is known of both."""
        return PairedRate.of([(a.clean, b.clean) for a, b in self.driven if None not in (a.clean, b.clean)])

    @cached_property
    def pet(self) -> Difference:
        """Difference of the mean PETs of an episode [s]."""
        return self._difference(lambda episode: mean(episode.pets))

    @cached_property
    def velocity(self) -> Difference:
        """Difference of the mean velocities of an episode [m/s]."""
        return self._difference(lambda episode: mean(episode.velocities))

    def _difference(self, measure: Callable[[ScoredEpisode], float | None]) -> Difference:
        measured = [(measure(a), measure(b)) for a, b in self.driven if a.success and b.success]
        differences = [a - b for a, b in measured if a is not None and b is not None]
        low, high = mean_interval(differences) or (None, None)
        return Difference(len(differences), mean(differences), low, high)

    @property
    def better(self) -> tuple[str, ...]:
        """Of clean success, success, velocity and PET those in which the method is shown to be better."""
        return self._shown(1)

    @property
    def worse(self) -> tuple[str, ...]:
        """Of clean success, success, velocity and PET those in which it is shown to be worse."""
        return self._shown(-1)

    def _shown(self, sign: int) -> tuple[str, ...]:
        found = {
            "clean": self.clean.shown(sign),
            "success": self.success.shown(sign),
            "velocity": self.velocity.shown(sign),
            "PET": self.pet.shown(sign),
        }
        return tuple(name for name, shown in found.items() if shown)

    def __str__(self) -> str:
        said = [f"{word} in {', '.join(w)}" for word, w in (("better", self.better), ("worse", self.worse)) if w]
        none = f"fewer than {FEWEST} pairs" if self.velocity.pairs < FEWEST else "no difference shown"
        return "; ".join(said) or none


def points(value: Value) -> str:
    """Write a difference of rates in percentage points."""
    return signed(100 * value, 1) if isinstance(value, float) else "-"


def p_text(value: Value) -> str:
    """Write a p-value."""
    return f"{value:.2g}" if isinstance(value, float) else "-"


# Columns of the paired comparison; every difference is the method minus codriving.
PAIRED: tuple[Column[PairedCells], ...] = (
    Column("pairs", lambda p: len(p.driven), "pairs", rank=5),
    Column(
        "clean_text",
        lambda p: points(p.clean.difference) if p.clean.pairs else "",
        "clean [points]",
        csv=False,
        sparse=True,
    ),
    Column(
        "clean_p_text", lambda p: p_text(p.clean.p) if p.clean.pairs else "", "clean p", csv=False, sparse=True, rank=4
    ),
    Column("success_difference", lambda p: p.success.difference, "success [points]", points),
    Column("only_method_succeeds", lambda p: p.success.gained),
    Column("only_codriving_succeeds", lambda p: p.success.lost),
    Column("alone", lambda p: f"{p.success.gained} / {p.success.lost}", "alone: it / codriving", csv=False, rank=6),
    Column("mcnemar_p", lambda p: p.success.p, "McNemar p", p_text, rank=4),
    Column(
        "velocity",
        lambda p: str(p.velocity),
        "velocity [m/s] (95 %)",
        csv=False,
        rank=2,
        brief=("velocity [m/s]", " ("),
    ),
    Column("pet_pairs", lambda p: p.pet.pairs),
    Column("pet_difference", lambda p: p.pet.mean),
    Column("pet_difference_low", lambda p: p.pet.low),
    Column("pet_difference_high", lambda p: p.pet.high),
    Column("pet", lambda p: str(p.pet), "PET [s] (95 %)", csv=False, rank=3, brief=("PET [s]", " (")),
    Column("velocity_pairs", lambda p: p.velocity.pairs),
    Column("velocity_difference", lambda p: p.velocity.mean),
    Column("velocity_difference_low", lambda p: p.velocity.low),
    Column("velocity_difference_high", lambda p: p.velocity.high),
    Column("clean_pairs", lambda p: p.clean.pairs),
    Column("clean_difference", lambda p: p.clean.difference),
    Column("only_method_clean", lambda p: p.clean.gained if p.clean.pairs else None),
    Column("only_codriving_clean", lambda p: p.clean.lost if p.clean.pairs else None),
    Column("clean_mcnemar_p", lambda p: p.clean.p),
    Column("better_in", lambda p: " ".join(p.better), words=True),
    Column("worse_in", lambda p: " ".join(p.worse), words=True),
    Column("against", str, AGAINST, words=True, csv=False, rank=1),
)
