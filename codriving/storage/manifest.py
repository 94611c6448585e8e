"""``manifest.json``: what a run was made of and with; nothing in it comes from the environment's variables."""

from dataclasses import dataclass
from pathlib import Path

from codriving.errors import RunFolderError
from codriving.storage.strict_json import decode, encode

MANIFEST = "manifest.json"
FORMAT = 1
"""Layout of the run folder; raised when an older reader could no longer read a newer folder."""


@dataclass(frozen=True, slots=True)
class CellEntry:
    """One cell of the run: a row of its summary.

    Attributes:
        folder: Name of its folder under ``episodes/``.
        scenario: Name of the scenario.
        method: Name of the method.
        variant: Name of the CDA variant.
        reasoner: Who reasons: ``rules`` or the name of a model.
        fingerprint: Hash of the settings that results depend on.
        settings: Those settings without secrets: JSON of each value, by dotted key.
    """

    folder: str
    scenario: str
    method: str
    variant: str
    reasoner: str
    fingerprint: str
    settings: dict[str, str]


@dataclass(frozen=True, slots=True)
class Manifest:
    """What a run was made of and with.

    Attributes:
        format: Layout of the folder.
        experiment: Name of the experiment.
        created: When the run began, UTC in ISO 8601.
        first_seed: Seed of the first episode of each cell.
        episodes: Episodes planned for each cell.
        cells: The cells in the order of the tables.
        versions: Version of each package that matters, by name.
        commit: Commit of the checkout, with ``+changes`` if it was not clean; None for an installed package.
        machine: Operating system, processor and number of cores.
    """

    format: int
    experiment: str
    created: str
    first_seed: int
    episodes: int
    cells: tuple[CellEntry, ...]
    versions: dict[str, str]
    commit: str | None
    machine: dict[str, str]


def manifest_text(manifest: Manifest) -> str:
    """Give the content of ``manifest.json``.

    Args:
        manifest: What the run is made of.

    Returns:
        JSON text.
    """
    return encode(manifest)


def read_manifest(folder: Path) -> Manifest | None:
    """Read the manifest of a run folder.

    Args:
        folder: The run folder.

    Returns:
        The manifest, or None if there is none.

    Raises:
        RunFolderError: If it is damaged or cannot be read.
    """
    path = folder / MANIFEST
    try:
        return decode(Manifest, path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except OSError as error:
        raise RunFolderError(f"cannot read {path}: {error.strerror}; check its permissions") from error
    except ValueError as error:
        raise RunFolderError(
            f"{path} is damaged ({error}), so nobody can tell what config the run is of; start a new one with "
            "another run=<name>: the episodes in the old folder stay readable"
        ) from error


def refuse_other_config(folder: Path, there: Manifest, here: Manifest) -> None:
    """Keep episodes of two configs out of one folder.

    Args:
        folder: The run folder.
        there: Its manifest.
        here: The manifest of the run that wants to go on in it.

    Raises:
        RunFolderError: If the two differ in anything that results depend on.
    """
    if [c.fingerprint for c in there.cells] == [c.fingerprint for c in here.cells]:
        return
    raise RunFolderError(
        f"{folder} holds a run of another config: {_differences(there, here)}; repeat its settings to go on with it, "
        "or choose another run=<name>"
    )


def _differences(there: Manifest, here: Manifest) -> str:
    """The keys in which two runs differ, with both values."""
    if len(there.cells) != len(here.cells):
        return f"it has {len(there.cells)} cells, this run has {len(here.cells)}"
    found: dict[str, str] = {}
    for old, new in zip(there.cells, here.cells, strict=True):
        for key in sorted(old.settings.keys() | new.settings.keys()):
            was, now = old.settings.get(key, "absent"), new.settings.get(key, "absent")
            if was != now:
                found.setdefault(key, f"{key} was {was}, is now {now}")
    # Only a masked value can differ in the fingerprint and not here.
    shown = list(found.values()) or ["a value that is not written down"]
    more = f" and {len(shown) - 5} more keys" if len(shown) > 5 else ""
    return ", ".join(shown[:5]) + more
