"""Where the episodes of a batch are driven, and when one that fails stops it."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from codriving.datatypes import Ending
from codriving.errors import ModelError, ModelUnavailableError
from codriving.experiment.asking import Asked
from codriving.experiment.launchers import Launcher, Serial
from codriving.experiment.objects import consults
from codriving.experiment.plan import Plan
from codriving.experiment.processes import Processes
from codriving.experiment.remembering import learns
from codriving.experiment.threads import Threads
from codriving.experiment.worker import Report, Unit


def places(
    missing: Sequence[Unit], unfilmed: Sequence[Unit], plan: Plan, models: Asked
) -> Iterator[tuple[Sequence[Unit], Launcher, int | str]]:
    """Say what is driven where, and by how many workers.

    Episodes whose method asks no language model are driven as the plan says. Those that ask one wait for its server
    nearly all the time, and share one client with its limits: they are driven in threads of this process, as many at
    once as requests may be under way, unless the launcher of the plan keeps to that. What asks a server in another way
    does not leave this machine, so that no key has to. Episodes that learn from one
    another come one after the other, each cell in the order of its seeds.
    """
    if not plan.launcher.drives:
        yield [*missing, *unfilmed], plan.launcher, 1
        return
    in_order = {cell.folder for cell in plan.cells if learns(cell.resolved)} & {unit.cell for unit in missing}
    independent = [unit for unit in missing if unit.cell not in in_order]
    computed = [unit for unit in independent if unit.cell not in models.models]
    waiting = [unit for unit in independent if unit.cell in models.models]
    at_home = {cell.folder for cell in plan.cells if plan.launcher.elsewhere and consults(cell.resolved)}
    threads = plan.launcher if plan.launcher.asks else Threads()
    if in_order:
        yield [unit for unit in missing if unit.cell in in_order], Serial(), 1
    if consulting := [unit for unit in computed if unit.cell in at_home]:
        yield consulting, Processes(), plan.workers
    if elsewhere := [*(unit for unit in computed if unit.cell not in at_home), *unfilmed]:
        yield elsewhere, plan.launcher, plan.workers
    if waiting:
        yield waiting, threads, side_by_side(plan.workers, models.concurrency)


def side_by_side(workers: int | str, concurrency: int) -> int:
    """Return the number of episodes that ask a language model to drive at once."""
    return concurrency if workers == "auto" else min(int(workers), concurrency)


class FailuresInARow:
    """Stops a batch: a language model that fails one episode after another will fail the next ones too."""

    def __init__(self, models: Mapping[str, str], most: Mapping[str, int]) -> None:
        self._models, self._most = models, most
        self._failures: Counter[str] = Counter()

    def note(self, report: Report) -> None:
        """Take note of an episode that has ended."""
        if (model := self._models.get(report.unit.cell)) is None:
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
