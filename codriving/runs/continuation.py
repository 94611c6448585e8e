"""Whether a run may go on in a folder, and what that then holds: it grows by episodes and cells, never shrinks."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from codriving.errors import RunFolderError
from codriving.runs.manifest import FORMAT, CellEntry, Manifest


def continued(folder: Path, there: Manifest, here: Manifest) -> Manifest:
    """Join what a folder holds with what is asked for now.

    Any number of episodes may be asked for, and cells beside those that are there, as long as one of them is there: it
    shows that the same experiment is meant. A cell keeps its folder, whatever it would be called now.

    Raises:
        RunFolderError: If no cell of the one is a cell of the other, or the folder has another layout.
    """
    if there.format != FORMAT:
        raise RunFolderError(
            f"{folder} was written by another version (layout {there.format}, not {FORMAT}), so nothing can be added; "
            "choose another run=<name>: what is in it stays as it is"
        )
    held = {cell.fingerprint: cell for cell in there.cells}
    if not any(cell.fingerprint in held for cell in here.cells):
        difference = _difference(there.cells, here.cells[0])
        raise RunFolderError(
            f"{folder} holds a run of another config: {difference}; repeat its settings to go on with it, or choose "
            "another run=<name>"
        )
    taken = {cell.folder.casefold() for cell in there.cells}
    asked = {cell.fingerprint: _placed(cell, held, taken) for cell in here.cells}
    return replace(
        there,
        episodes=here.episodes,
        rows=tuple(cell.folder for cell in asked.values()),
        cells=tuple((held | asked).values()),
    )


def changed_versions(there: Manifest, here: Manifest) -> tuple[str, ...]:
    """Compare what a run began with and what it goes on with."""
    before = {**there.versions, "commit": (there.commit or "none")}
    now = {**here.versions, "commit": (here.commit or "none")}
    names = sorted(before.keys() | now.keys())
    pairs = [(name, before.get(name, "none"), now.get(name, "none")) for name in names]
    return tuple(f"{name} {was} -> {is_}" for name, was, is_ in pairs if was != is_)


def _placed(cell: CellEntry, held: dict[str, CellEntry], taken: set[str]) -> CellEntry:
    """Give a cell the folder that it has, or one that no other cell has."""
    if cell.fingerprint in held:
        return replace(cell, folder=held[cell.fingerprint].folder)
    if cell.folder.casefold() in taken:
        return replace(cell, folder=f"{cell.folder}-{cell.fingerprint[:8]}")
    return cell


def _difference(there: Sequence[CellEntry], new: CellEntry) -> str:
    """The keys in which a cell differs from the one that is most like it, with both values."""
    nearest = min((_differences(old, new) for old in there), key=len)
    # Only a masked value can differ in the fingerprint and not here.
    shown = nearest or ["a value that is not written down"]
    more = f" and {len(shown) - 5} more keys" if len(shown) > 5 else ""
    return ", ".join(shown[:5]) + more


def _differences(old: CellEntry, new: CellEntry) -> list[str]:
    pairs = {
        key: (old.settings.get(key, "absent"), new.settings.get(key, "absent"))
        for key in sorted(old.settings.keys() | new.settings.keys())
    }
    differing = {key: f"{key} was {was}, is now {now}" for key, (was, now) in pairs.items() if was != now}
    # What refers to another key (environment.scenario.cavs) differs along with it.
    return [text for key, text in differing.items() if not any(key.endswith(f".{other}") for other in differing)]
