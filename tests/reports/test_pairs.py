"""One method against another: only what both did on one seed is compared."""

from collections.abc import Callable

from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.reports.columns import Row, table
from codriving.reports.pairs import PAIRED, Difference, PairedCells, PairedRate, corrected, paired_columns
from codriving.reports.results import CellResults

Make = Callable[..., EpisodeRecord]

LOST = Ending.COLLISION


def paired(records: list[EpisodeRecord], reference: list[EpisodeRecord]) -> Row:
    return table(PAIRED, [PairedCells(CellResults(records), CellResults(reference))]).rows[0]


def test_success_is_counted_seed_by_seed(make: Make) -> None:
    theirs = [make(0), make(1), make(2, LOST), make(3, LOST), make(9)]
    ours = [make(0), make(1, LOST), make(2), make(3, Ending.TIMEOUT), make(8)]
    row = paired(theirs, ours)
    assert (row["pairs"], row["only_method_succeeds"], row["only_codriving_succeeds"]) == (4, 1, 1)
    assert (row["success_difference"], row["mcnemar_p"]) == (0.0, 1.0)


def test_an_error_is_no_driving_and_leaves_its_pair_out(make: Make) -> None:
    row = paired([make(0), make(1, Ending.ERROR), make(2)], [make(0, LOST), make(1), make(2, Ending.ERROR)])
    assert (row["pairs"], row["success_difference"]) == (1, 1.0)
    assert paired([make(0, Ending.ERROR)], [make(0)])["mcnemar_p"] is None


def test_velocity_and_pet_are_means_of_an_episode_where_both_succeed(make: Make) -> None:
    theirs = [
        make(0, pets=(2.0, 4.0), velocities=(6.0, 8.0)),
        make(1, pets=(), velocities=(5.0,)),
        make(2, LOST, pets=(90.0,), velocities=(90.0,)),
    ]
    ours = [
        make(0, pets=(1.0,), velocities=(6.0,)),
        make(1, pets=(1.0,), velocities=(6.0,)),
        make(2, pets=(1.0,), velocities=(6.0,)),
    ]
    row = paired(theirs, ours)
    assert (row["velocity_pairs"], row["velocity_difference"]) == (2, 0.0)
    assert (row["pet_pairs"], row["pet_difference"]) == (1, 2.0)
    assert row["pet_difference_low"] is None


def test_the_interval_is_of_the_pairs_and_not_of_the_methods(make: Make) -> None:
    # The seeds differ by far more than the methods: only pairing shows that one of them is faster.
    theirs = [make(seed, velocities=(5.0 + seed % 7 + 0.1 + 0.01 * (seed % 3),)) for seed in range(20)]
    ours = [make(seed, velocities=(5.0 + seed % 7,)) for seed in range(20)]
    row = paired(theirs, ours)
    low, high = row["velocity_difference_low"], row["velocity_difference_high"]
    assert isinstance(low, float)
    assert isinstance(high, float)
    assert 0.1 <= low < high <= 0.12
    assert (row["better_in"], row["worse_in"]) == ("velocity", "")
    assert paired(ours, theirs)["worse_in"] == "velocity"


def rate(p: float, difference: float) -> PairedRate:
    """A difference of 100 pairs with a p-value of its own."""
    found = PairedRate(100, max(round(100 * difference), 0), max(round(-100 * difference), 0))
    found.__dict__["p"] = p
    return found


def shown(
    p: float = 1.0, success: float = 0.0, clean: float = 0.0, **limits: tuple[float, float]
) -> tuple[tuple[str, ...], ...]:
    """In what a method is better and worse."""
    pairs = PairedCells(CellResults([]), CellResults([]))
    cached = {what: Difference(20, 0.0, *limits.get(what, (None, None))) for what in ("pet", "velocity")}
    pairs.__dict__.update(cached, success=rate(p, success), clean=rate(p, clean))
    return pairs.better, pairs.worse


def test_better_and_worse_need_a_p_below_005_or_an_interval_without_0() -> None:
    assert shown() == ((), ())
    assert shown(p=0.049, success=0.1) == (("success",), ())
    assert shown(p=0.05, success=0.1) == ((), ())
    assert shown(p=0.01, success=-0.1) == ((), ("success",))
    assert shown(p=0.01, clean=0.1) == (("clean",), ())
    assert shown(velocity=(0.1, 0.2)) == (("velocity",), ())
    assert shown(velocity=(-0.1, 0.2)) == ((), ())
    assert shown(pet=(-0.2, -0.1)) == ((), ("PET",))
    assert shown(pet=(0.0, 0.0)) == ((), ())


def _lost(make: Make, *seeds: int) -> CellResults:
    return CellResults([make(seed, LOST if seed in seeds else Ending.SUCCESS) for seed in range(20)])


def test_a_row_of_several_has_to_differ_by_more(make: Make) -> None:
    """Of three rows the least p, 2 / 2^9 = 0.0039, counts three times, the second, 2 / 2^6 = 0.031, twice."""
    rows = [_lost(make, *range(6)), _lost(make, *range(9)), _lost(make)]
    alone = [PairedCells(row, _lost(make)) for row in rows]
    together = corrected(alone)
    assert [pairs.worse for pairs in alone] == [("success",), ("success",), ()]
    assert [pairs.worse for pairs in together] == [(), ("success",), ()]
    assert [round(pairs.success.corrected or 0, 4) for pairs in together] == [0.0625, 0.0117, 1.0]
    assert [round(pairs.success.p or 0, 4) for pairs in together] == [0.0312, 0.0039, 1.0]


def test_level_is_at_most_three_points_lower_and_not_shown_to_be_worse() -> None:
    def level(pairs: int, gained: int, lost: int, p: float | None = None) -> bool:
        return PairedRate(pairs, gained, lost, p).level

    assert level(100, 3, 0)
    assert not level(100, 4, 0)
    assert level(100, 5, 2)
    assert level(1000, 9, 0, 0.05)
    assert not level(1000, 9, 0, 0.049)
    assert level(100, 0, 50, 0.001)
    assert level(10, 0, 0)
    assert not level(9, 0, 0), "of few pairs nothing is said"
    assert not level(0, 0, 0)


def test_columns_name_the_reference() -> None:
    assert "only_full_succeeds" in [column.key for column in paired_columns("full", "against full")]
