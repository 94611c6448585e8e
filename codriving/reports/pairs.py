"""One method against another on the same seeds: where which succeeds, and how far apart they are where both do."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from codriving.datatypes import Ending
from codriving.metrics import FEWEST, holm, mcnemar, mean_interval, paired_interval
from codriving.reports.columns import Column, Value, mean
from codriving.reports.results import CellResults, ScoredEpisode
from codriving.reports.wording import signed

SIGNIFICANT = 0.05  # A p-value below this counts as a difference

LEVEL = 0.03  # By how much the lower of two level rates is lower at most

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
    lost: int  # What it is compared with alone
    corrected: float | None = None  # p-value corrected for the number of rows; None for one that stands by itself
    both: int = 0

    @classmethod
    def of(cls, pairs: Sequence[tuple[object, object]]) -> "PairedRate":
        """Count the pairs."""
        gained, lost = sum(bool(a and not b) for a, b in pairs), sum(bool(b and not a) for a, b in pairs)
        return cls(len(pairs), gained, lost, both=sum(bool(a and b) for a, b in pairs))

    @property
    def difference(self) -> float | None:
        """Difference of the rates."""
        return (self.gained - self.lost) / self.pairs if self.pairs else None

    @cached_property
    def interval(self) -> tuple[float, float] | None:
        """Newcombe's 95 % interval of the difference; None of too few seeds."""
        return paired_interval(self.both, self.gained, self.lost, self.pairs)

    @cached_property
    def p(self) -> float | None:
        """p-value of the exact McNemar test."""
        return mcnemar(self.gained, self.lost) if self.pairs else None

    def shown(self, sign: int) -> bool:
        """Tell whether the method is shown to be better (1) or worse (-1)."""
        p = self.p if self.corrected is None else self.corrected
        return p is not None and p < SIGNIFICANT and (self.gained - self.lost) * sign > 0

    @property
    def level(self) -> bool:
        """Whether the reference is level with the method: at most 3 points lower, and not shown to be worse.

        Of few pairs it is not said.
        """
        return self.pairs >= FEWEST and self.gained - self.lost <= LEVEL * self.pairs + 1e-9 and not self.shown(1)


@dataclass(frozen=True)
class PairedCells:
    """The episodes of a method and those of codriving; pairs of which one ended in an error are left out."""

    cell: CellResults
    reference: CellResults
    success_p: float | None = None  # Corrected for the number of rows
    clean_p: float | None = None

    @cached_property
    def driven(self) -> list[tuple[ScoredEpisode, ScoredEpisode]]:
        """Both episodes of each seed that both drove to an end."""
        by_seed = {episode.record.seed: episode for episode in self.reference.episodes}
        pairs = [(one, by_seed[one.record.seed]) for one in self.cell.episodes if one.record.seed in by_seed]
        return [(a, b) for a, b in pairs if Ending.ERROR not in (a.record.outcome.ending, b.record.outcome.ending)]

    @cached_property
    def success(self) -> "PairedRate":
        """Which of them succeeds."""
        return replace(PairedRate.of([(a.success, b.success) for a, b in self.driven]), corrected=self.success_p)

    @cached_property
    def clean(self) -> "PairedRate":
        """Which of them succeeds without a near miss, where that is known of both."""
        known = [(a.clean, b.clean) for a, b in self.driven if None not in (a.clean, b.clean)]
        return replace(PairedRate.of(known), corrected=self.clean_p)

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

    @property
    def level(self) -> tuple[str, ...]:
        """Of clean success and success those in which the reference is level with the method, or above it."""
        return tuple(name for name, rate in (("clean", self.clean), ("success", self.success)) if rate.level)

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


def corrected(pairs: Sequence[PairedCells]) -> list[PairedCells]:
    """Correct the tests of several rows for their number (Holm): those of success, and those of clean success."""

    def values(rates: Sequence[PairedRate]) -> list[float | None]:
        known = [k for k, rate in enumerate(rates) if rate.p is not None]
        found = dict(zip(known, holm([p for rate in rates if (p := rate.p) is not None]), strict=True))
        return [found.get(k) for k in range(len(rates))]

    success, clean = values([p.success for p in pairs]), values([p.clean for p in pairs])
    return [PairedCells(p.cell, p.reference, s, c) for p, s, c in zip(pairs, success, clean, strict=True)]


def points(value: Value) -> str:
    """Write a difference of rates in percentage points."""
    return signed(100 * value, 1) if isinstance(value, float) else "-"


def p_text(value: Value) -> str:
    """Write a p-value."""
    return f"{value:.2g}" if isinstance(value, float) else "-"


def paired_columns(reference: str, against: str) -> tuple[Column[PairedCells], ...]:
    """Give the columns of a paired comparison; every difference is the method minus the reference."""
    return (
        Column("pairs", lambda p: len(p.driven), "pairs", rank=5),
        _clean_text("clean_text", "clean [points]", lambda rate: points(rate.difference)),
        _clean_text("clean_p_text", "clean p", lambda rate: p_text(rate.p), rank=4),
        _clean_text("clean_holm", "clean p (Holm)", lambda rate: p_text(rate.corrected), rank=2),
        Column("success_difference", lambda p: p.success.difference, "success [points]", points),
        Column("only_method_succeeds", lambda p: p.success.gained),
        Column(f"only_{reference}_succeeds", lambda p: p.success.lost),
        Column(
            "alone", lambda p: f"{p.success.gained} / {p.success.lost}", f"alone: it / {reference}", csv=False, rank=6
        ),
        Column("mcnemar_p", lambda p: p.success.p, "McNemar p", p_text, rank=4),
        Column("success_holm", lambda p: p_text(p.success.corrected), "p (Holm)", csv=False, rank=2),
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
        Column(f"only_{reference}_clean", lambda p: p.clean.lost if p.clean.pairs else None),
        Column("clean_mcnemar_p", lambda p: p.clean.p),
        Column("better_in", lambda p: " ".join(p.better), words=True),
        Column("worse_in", lambda p: " ".join(p.worse), words=True),
        Column("mcnemar_p_holm", lambda p: p.success.corrected),
        Column("clean_mcnemar_p_holm", lambda p: p.clean.corrected),
        Column("level_in", lambda p: " ".join(p.level), words=True),
        Column("against", str, against, words=True, csv=False, rank=1),
    )


def _clean_text(key: str, head: str, text: Callable[[PairedRate], str], rank: int = 0) -> Column[PairedCells]:
    return Column(key, lambda p: text(p.clean) if p.clean.pairs else "", head, csv=False, sparse=True, rank=rank)


PAIRED = paired_columns("codriving", AGAINST)
