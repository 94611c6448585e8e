"""When a batch stops by itself: a language model that fails one episode after another will fail the next ones too."""

from collections import Counter
from collections.abc import Mapping

from codriving.datatypes.outcome import Ending
from codriving.errors import ModelError, ModelUnavailableError
from codriving.experiment.episodes.job import Report


class FailuresInARow:
    """Counts the episodes that ended because a model did not answer, one after another as they end."""

    def __init__(self, models: Mapping[str, str], most: Mapping[str, int]) -> None:
        self._models, self._most = models, most
        self._failures: Counter[str] = Counter()

    def note(self, report: Report) -> None:
        """Take note of an episode that has ended.

        Raises:
            ModelError: If its model has failed too often in a row.
        """
        model = self._models.get(report.unit.cell)
        if model is None:
            return
        name = f"{ModelUnavailableError.__name__}: "
        if report.ending is not Ending.ERROR or not report.message.startswith(name):
            self._failures[model] = 0
            return
        self._failures[model] += 1
        if self._failures[model] >= self._most[model]:
            raise ModelError(
                f"{model} failed {self._failures[model]} episodes in a row (llm.failures_in_a_row), the last with: "
                f"{report.message.removeprefix(name)}"
            )
