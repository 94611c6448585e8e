"""Whether a run may go on in a folder, and what that then holds: it grows by episodes and cells, never shrinks."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from codriving.errors import RunFolderError
from codriving.runs.identity import BEHAVIOUR, NEW_WORLD, CellEntry, changed_files, same_cell, same_settings
from codriving.runs.manifest import Manifest


def continued(folder: Path, there: Manifest, here: Manifest) -> Manifest:
    """Join what a folder holds with what is asked for now.

    Any number of episodes may be asked for, and cells beside those that are there, as long as one of them is there: it
    shows that the same experiment is meant. A cell keeps its folder, whatever it would be called now.
    """
    pairs = [(next((old for old in there.cells if same_cell(old, cell)), None), cell) for cell in here.cells]
    for old, cell in pairs:
        if old is None:
            _refuse_changed(folder, there.cells, cell)
    if all(old is None for old, _ in pairs):
        world = ", of which suite=paper is the world unless it named another," if there.behaviour < NEW_WORLD else ""
        raise RunFolderError(
            f"{folder} holds a run of another config: {_difference(there.cells, here.cells[0])}; repeat its settings"
            f"{world} to go on with it, or choose another run=<name>"
        )
    taken = {cell.folder.casefold() for cell in there.cells}
    asked = {
        (old or cell).folder: replace(cell, folder=old.folder, repeatable=old.repeatable)
        if old
        else replace(cell, folder=_free(cell, taken))
        for old, cell in pairs
    }
    held = {cell.folder: cell for cell in there.cells}
    rows = tuple(cell.folder for cell in asked.values())
    if there.behaviour == BEHAVIOUR:
        held |= {cell.folder: cell for cell in asked.values()}
    elif not set(rows) <= held.keys():
        raise other_behaviour(folder, there)
    return replace(there, episodes=here.episodes, rows=rows, cells=tuple(held.values()))


def difference(there: Manifest, here: Manifest) -> str | None:
    """Say in what the cells of a run that are asked for differ from those of another; None if each is one of these."""
    for cell in here.cells:
        if cell.folder in here.rows and not any(same_cell(old, cell) for old in there.cells):
            others = [old for old in there.cells if not any(same_cell(old, one) for one in here.cells)] or there.cells
            changed = [text for old in others if same_settings(old, cell) for text in changed_files(old, cell)]
            return ", ".join(changed) or _difference(others, cell)
    return None


def other_behaviour(folder: Path, there: Manifest) -> RunFolderError:
    """Return the error for a folder to which this version must not add, since it would drive otherwise."""
    release = there.versions.get("codriving", "another release")
    if ".dev" in release and there.commit:
        release += f" of commit {there.commit[:10]}"
    return RunFolderError(
        f"{folder} was driven by codriving {release} (behaviour {there.behaviour}, here {BEHAVIOUR}), so it can be "
        f"replayed and reported but not extended; extend it with codriving {release}, or choose another run=<name>"
    )


def measured(folder: Path, cell: str) -> RunFolderError:
    """Return the error for a cell of which no further episode would be like those that are there."""
    return RunFolderError(
        f"{cell} in {folder} was driven, or would be, with llm.latency=measured and a model that is asked, so that it "
        "cannot be repeated and is not extended; choose another run=<name> (llm.cache=use keeps the times of answers)"
    )


def changed_versions(there: Manifest, here: Manifest) -> tuple[str, ...]:
    """Compare what a run began with and what it goes on with."""
    before, now = ({**one.versions, "commit": one.commit or "none"} for one in (there, here))
    return tuple(f"{name} {was} -> {is_}" for name, was, is_ in _changes(before, now, "none"))


def _changes(before: Mapping[str, str], now: Mapping[str, str], absent: str) -> Iterator[tuple[str, str, str]]:
    """Each key whose value differs, with both values."""
    for key in sorted(before.keys() | now.keys()):
        if before.get(key) != now.get(key):
            yield key, before.get(key, absent), now.get(key, absent)


def _refuse_changed(folder: Path, there: Sequence[CellEntry], cell: CellEntry) -> None:
    for old in there:
        if same_settings(old, cell) and (changed := list(changed_files(old, cell))):
            more = f" and {len(changed) - 3} more files" if len(changed) > 3 else ""
            raise RunFolderError(
                f"{', '.join(changed[:3])}{more} since {folder} was begun, so nothing can be added to {old.folder}; "
                "restore it, or choose another run=<name>"
            )


def _free(cell: CellEntry, taken: set[str]) -> str:
    """Return the name of a folder that no other cell has."""
    return f"{cell.folder}-{cell.fingerprint[:8]}" if cell.folder.casefold() in taken else cell.folder


def _difference(there: Sequence[CellEntry], new: CellEntry) -> str:
    """The keys in which a cell differs from the one that is most like it, with both values."""
    # Only a masked value can differ in the fingerprint and not here.
    shown = min((_differences(old, new) for old in there), key=len) or ["a value that is not written down"]
    return ", ".join(shown[:5]) + (f" and {len(shown) - 5} more keys" if len(shown) > 5 else "")


def _differences(old: CellEntry, new: CellEntry) -> list[str]:
    was, now = _told(old), _told(new)
    if not old.choices:
        # Of release 0.1 there are no more names than these, and no files.
        now = {key: value for key, value in now.items() if key in was or key in new.settings}
    return [f"{key} was {before}, is now {after}" for key, before, after in _changes(was, now, "absent")]


def _told(cell: CellEntry) -> dict[str, str]:
    names = {"scenario": cell.scenario, "method": cell.method, **cell.choices}
    # A node without settings would stand in the place of its name.
    return {**cell.settings, **names, **{file.name: file.sha256[:12] for file in cell.files}}
