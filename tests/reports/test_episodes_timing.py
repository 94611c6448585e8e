"""timing.csv: seconds, and what they are of."""

from collections.abc import Callable

import pytest

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.columns import table
from codriving.reports.episodes import TimedEpisode, cpu_per_decision, timing_columns
from codriving.runs.episode_folder import timing_of


def test_a_row_says_what_it_is_of_and_what_it_cost(make: Callable[..., EpisodeRecord]) -> None:
    timed = [(make(3), timing_of(2.0, [0.25, 0.75], [0.125, 0.375])), (make(4), None)]
    episodes = [TimedEpisode(record, timing, {"scenario.cavs": "8"}) for record, timing in timed]
    made = table(timing_columns(["scenario.cavs"]), episodes)
    (known, lost), columns = made.rows, made.keys
    assert columns[:7] == ("scenario", "method", "variant", "reasoner", "seed", "scenario.cavs", "seconds")
    assert [known[column] for column in columns[4:]] == [3, "8", 2.0, 12, 0.5, 0.75, 0.25, 0.375]
    assert (lost["scenario.cavs"], lost["seconds"], lost["decision_seconds_max"]) == ("8", None, None)


def test_every_decision_counts_once_in_the_computing_time_of_a_cell() -> None:
    measured = [timing_of(1.0, [1.0], [0.2]), timing_of(3.0, [1.0, 1.0, 1.0], [0.4, 0.4, 0.4])]
    assert cpu_per_decision([*measured, None, timing_of(1.0, [9.0])]) == pytest.approx(0.35)
    assert cpu_per_decision([None, timing_of(1.0, [9.0]), timing_of(0.0, [], [])]) is None
