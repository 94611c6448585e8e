"""Parts of a run, found and checked, and brought together episode by episode."""

import shlex
import shutil
from collections import Counter
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from glob import escape
from pathlib import Path
from typing import ClassVar

from codriving.datatypes import Ending
from codriving.errors import DamagedEpisodeError, RunFolderError
from codriving.experiment.batch import manifest_of
from codriving.experiment.launchers import Launcher
from codriving.experiment.plan import Plan
from codriving.experiment.worker import Job, Report, Unit
from codriving.runs import (
    BEHAVIOUR,
    MANIFEST,
    PART,
    PARTS,
    Manifest,
    Part,
    Shard,
    changed_versions,
    checked_record,
    difference,
    episode_folder,
    read_manifest,
    read_part,
    read_record,
    same_cell,
    unwritable,
    whole_folder,
)

# Keys by which the commands of two shards may differ.
APART = ("shard", "workers", "launcher", "output", "run")


@dataclass(frozen=True, slots=True)
class FoundPart:
    """A part, with what it says of itself."""

    folder: Path
    part: Part
    manifest: Manifest

    @classmethod
    def of(cls, folder: Path) -> "FoundPart":
        """Read it."""
        part = read_part(folder)
        if (manifest := read_manifest(folder)) is None:
            raise RunFolderError(f"{folder} has no {MANIFEST}; run the command of this shard again")
        return cls(folder, part, manifest)

    @property
    def driving(self) -> list[str]:
        """What was typed, as far as the shards of a run have it in common."""
        return [t for t in self.part.arguments if t.lstrip("+").partition("=")[0].partition(".")[0] not in APART]

    @property
    def typed(self) -> str:
        """The command that drives the run, for a message."""
        return shlex.join(["codriving", *self.part.command.split(), *self.driving])

    def shard_command(self, run: str, shard: Shard) -> str:
        """Return the command that drives a shard of this run."""
        kept = [token for token in self.part.arguments if not token.lstrip("+").startswith("run=")]
        folder = ["--config-dir", self.part.config_dir] if self.part.config_dir else []
        words = [*self.part.command.split(), *kept, f"run={run}", f"shard={shard}", *folder]
        return shlex.join(["codriving", *words])


def find_parts(runs: Sequence[Path]) -> tuple[Path, list[Path]]:
    """Find the folders of parts, each once.

    Args:
        runs: Folders of runs or their names below ``outputs/``, or parts.

    Returns:
        The folder of the run, which is that of the first, and the parts.
    """
    found: dict[Path, tuple[int, Path]] = {}
    homes = []
    for run in map(_place, runs):
        if (run / PART).is_file():
            if run.absolute().parent.name != PARTS:
                raise RunFolderError(f"{run} is a part, but in no folder {PARTS}; put it into <run folder>/{PARTS}/")
            inside, home = [run], (run if len(run.parts) > 4 else run.absolute()).parent.parent
        else:
            inside, home = [path.parent for path in run.glob(f"{PARTS}/[!.]*/{PART}")], run
        if not inside:
            raise RunFolderError(f"{run} has no {PARTS}; the command of a run with shard=1/4 drives the first of four")
        homes.append(home)
        found |= {folder.resolve(): (read_part(folder).index, folder) for folder in inside}
    # Its name and its experiment are those of the run.
    named = len(homes[0].parts) > 2 and ".." not in homes[0].parts[-2:]
    return homes[0] if named else homes[0].resolve(), [folder for _, folder in sorted(found.values())]


def _place(run: Path) -> Path:
    if run.is_dir():
        return run
    named = sorted(Path("outputs").glob(f"*/{escape(str(run))}/{PARTS}")) if len(run.parts) == 1 else []
    if len(named) > 1:
        raise RunFolderError(f"several runs are called {run}: {', '.join(str(p.parent) for p in named)}; give a path")
    if not named:
        known = [str(path.parent) for path in sorted(Path("outputs").glob(f"*/*/{PARTS}"))]
        raise RunFolderError(f"there is no run folder {run}; runs with parts: {', '.join(known[-10:]) or 'none'}")
    return named[0].parent


def check_alike(parts: Sequence[FoundPart], mixed: bool = False) -> None:
    """Refuse parts of different runs, and of different versions.

    Args:
        mixed: Whether packages and commit may differ.
    """
    first = parts[0]
    for other in parts[1:]:
        both = f"{first.folder} and {other.folder}"
        if first.part.count != other.part.count:
            raise RunFolderError(
                f"{both} are of {first.part.count} and of {other.part.count} shards; name the parts that belong "
                f"together, as in {first.folder.parent}/*-of-{first.part.count}"
            )
        if (first.part.command, first.driving) != (other.part.command, other.driving):
            raise RunFolderError(
                f"{both} are parts of different runs, {first.typed} and {other.typed}; take away what does not belong"
                " here, or drive it again"
            )
        if told := difference(first.manifest, other.manifest):
            raise RunFolderError(f"{both} are parts of different runs: {told}; drive one of them again")
    for part in parts:
        if part.manifest.behaviour != BEHAVIOUR:
            release = part.manifest.versions.get("codriving", "another release")
            raise RunFolderError(
                f"{part.folder} was driven by codriving {release} (behaviour {part.manifest.behaviour}, here "
                f"{BEHAVIOUR}); join it with that version, or drive it again"
            )
        changed = changed_versions(first.manifest, part.manifest)
        if changed and not mixed:
            raise RunFolderError(
                f"{first.folder} and {part.folder} were driven by different versions: {', '.join(changed)}; drive one "
                "of them again, or join them all the same with --mixed"
            )


@dataclass(frozen=True, slots=True)
class Joining:
    """The parts of a run, which are checked against its plan."""

    run: Path
    parts: Sequence[FoundPart]

    def joined(self, plan: Plan) -> Plan:
        """Make of the plan of a run one by which its episodes are brought from the parts."""
        if plan.experiment != self.run.parent.name:
            raise RunFolderError(
                f"{self.run} has to lie in a folder {plan.experiment}, as it was driven; rename {self.run.parent}"
            )
        placed = replace(plan, output=self.run.parents[1], run=self.run.name)
        first = self.parts[0]
        if told := difference(first.manifest, manifest_of(plan, {})):
            raise RunFolderError(
                f"{first.folder} is not what its command drives here: {told}; restore that, or drive the parts again"
            )
        origin = replace(
            first.manifest,
            created=min(part.manifest.created for part in self.parts),
            versions={name: v for part in self.parts[::-1] for name, v in part.manifest.versions.items()},
        )
        return replace(placed, launcher=JoinParts(self.run, self._sources(placed), origin))

    def learnt(self, plan: Plan) -> Plan:
        """Find what was learnt before the tests, which are in parts."""
        placed = replace(plan, output=self.run.parents[1], run=self.run.name)
        folder = placed.output / placed.experiment / self.run.name
        if read_manifest(folder) is None:
            raise RunFolderError(f"what was learnt is not in {folder}; copy it from where the shards have learnt it")
        return replace(placed, launcher=JoinParts(folder, {}, None))

    def _sources(self, plan: Plan) -> dict[tuple[str, int], Path]:
        """Find all episodes of the run, or say which shards have to go on."""
        found: dict[tuple[str, int], Path] = {}
        damaged: list[DamagedEpisodeError] = []
        cells = [cell.entry() for cell in plan.driven]
        for place, seed in plan.units:
            cell = cells[place]
            for part in self.parts:
                there = next((old for old in part.manifest.cells if same_cell(old, cell)), None)
                if there is None:
                    # Its command stood for fewer cells when it was driven.
                    continue
                folder = episode_folder(part.folder, there.folder, seed)
                try:
                    record = checked_record(part.folder, there, seed)
                except DamagedEpisodeError as error:
                    damaged.append(error)
                    continue
                known = found.get((cell.fingerprint, seed))
                if known is None and record is not None:
                    found[cell.fingerprint, seed] = folder
                elif known is not None and record is not None:
                    found[cell.fingerprint, seed] = _same_episode(known, folder)
        self._refuse_incomplete(plan, found, damaged)
        return found

    def _refuse_incomplete(
        self, plan: Plan, found: Mapping[tuple[str, int], Path], damaged: Sequence[DamagedEpisodeError]
    ) -> None:
        count, first = self.parts[0].part.count, plan.first_seed
        shards = [Shard(index + 1, count) for index in range(count)]
        of = {(place, seed): next(s for s in shards if s.has(place, seed - first)) for place, seed in plan.units}
        all_of = Counter(of.values())
        prints = [cell.fingerprint for cell in plan.driven]
        lacks = Counter(shard for (place, seed), shard in of.items() if (prints[place], seed) not in found)
        there = {part.part.shard for part in self.parts}
        told = [
            f"{shard} {f'lacks {lacks[shard]} of {all_of[shard]} episodes' if shard in there else 'is missing'}"
            for shard in shards
            if lacks[shard]
        ]
        if told:
            also = f", {str(damaged[0]).partition(';')[0]}" if damaged else ""
            again = self.parts[0].shard_command(self.run.name, next(shard for shard in shards if lacks[shard]))
            more = "" if len(told) == 1 else ", and so on"
            raise RunFolderError(
                f"{self.run} cannot be joined yet: shard {_listed(told)}{also}; go on with: {again}{more}"
            )


def _listed(told: Sequence[str]) -> str:
    more = f" and {len(told) - 5} more" if len(told) > 5 else ""
    return ", ".join(told[:5]) + more


def _same_episode(one: Path, other: Path) -> Path:
    """Choose among two records of one episode, of which one may have ended in an error."""
    records = [read_record(folder) for folder in (one, other)]
    whole = [f for f, r in zip((one, other), records, strict=True) if r.outcome.ending is not Ending.ERROR]
    if len(whole) == 2 and records[0] != records[1]:
        raise RunFolderError(f"{one} and {other} are one episode, but were driven differently; delete one of them")
    return [*whole, one][0]


@dataclass(frozen=True)
class JoinParts(Launcher):
    """Brings episodes from parts instead of driving them."""

    run: Path
    sources: Mapping[tuple[str, int], Path]  # Folder of each episode, by the fingerprint of its cell and its seed
    origin: Manifest | None  # By what they were driven

    drives: ClassVar[bool] = False

    def noted(self, manifest: Manifest) -> Manifest:
        if self.origin is None:
            return manifest
        origin = self.origin
        return replace(
            manifest, created=origin.created, versions=origin.versions, commit=origin.commit, machine=origin.machine
        )

    def launch(
        self, units: Sequence[Unit], job: Job, workers: int | str, preload: Sequence[str]
    ) -> Generator[Report, None, None]:
        manifest = read_manifest(self.run)
        prints = {cell.folder: cell.fingerprint for cell in manifest.cells} if manifest else {}
        for unit in units:
            source = self.sources.get((prints[unit.cell], unit.seed))
            if source is None:
                raise RunFolderError(f"{self.run} is not complete; go on with the command that drives it")
            if job.saved(unit) is None:
                self._bring(source, episode_folder(self.run, unit.cell, unit.seed))
            if job.after:
                job.after.finish(unit)
            outcome = read_record(source).outcome
            yield Report(unit, outcome.ending, outcome.message)

    def _bring(self, source: Path, target: Path) -> None:
        try:
            with whole_folder(target) as partial:
                for path in sorted(source.iterdir()):
                    if path.is_file() and not path.is_symlink() and not path.name.startswith("."):
                        shutil.copyfile(path, partial / path.name)
        except OSError as error:
            raise unwritable(self.run, error) from error
