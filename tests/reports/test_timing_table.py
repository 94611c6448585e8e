"""timing.csv: seconds, and what they are of."""

from collections.abc import Callable

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.timing_table import timing_columns, timing_rows
from codriving.storage.timing import timing_of


def test_a_row_says_what_it_is_of_and_what_it_cost(make: Callable[..., EpisodeRecord]) -> None:
    timed = [(make(3), timing_of(2.0, [0.25, 0.75])), (make(4), None)]
    known, lost = timing_rows(timed, {"scenario.cavs": "8"})
    columns = timing_columns(["scenario.cavs"])
    assert columns[:7] == ("scenario", "method", "variant", "reasoner", "seed", "scenario.cavs", "seconds")
    assert [known[column] for column in columns[4:]] == [3, "8", 2.0, 12, 0.5, 0.75]
    assert (lost["scenario.cavs"], lost["seconds"], lost["decision_seconds_max"]) == ("8", None, None)
