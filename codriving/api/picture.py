"""A figure as a notebook shows it, and as files."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from codriving.errors import ConfigError, RunFolderError, require


@dataclass(frozen=True)
class DrawnFigure:
    """One figure; its bytes are the same each time."""

    name: str
    png: bytes = field(repr=False)
    svg: bytes = field(repr=False)

    def save(self, path: str | Path) -> Path:
        """Write it as what the name of the file says, ``.png`` or ``.svg``."""
        require(isinstance(path, str | Path), f"a file is named by a text or a path, got {path!r:.100}")
        path = Path(path)
        content = {".png": self.png, ".svg": self.svg}.get(path.suffix.lower())
        if content is None:
            raise ConfigError(f"a figure is .png or .svg, got {path.name!r:.100}; name the file so")
        try:
            path.write_bytes(content)
        except OSError as error:
            raise RunFolderError(f"cannot write {path}: {error.strerror or error}; choose another name") from error
        return path

    def _repr_png_(self) -> bytes:
        return self.png


def pictures_of(files: Mapping[str, bytes]) -> dict[str, DrawnFigure]:
    """Put the two files of each figure together."""
    names = dict.fromkeys(name.rpartition(".")[0] for name in files)
    return {name: DrawnFigure(name, files[f"{name}.png"], files[f"{name}.svg"]) for name in names}
