"""Gymnasium learns of our environments when it is imported, and `import codriving` alone does not import it."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.machinery import ModuleSpec
    from types import ModuleType

GYMNASIUM = "gymnasium"
ENTRY_POINT = "codriving.gym.joint:JointDriving"


def env_id(scenario: str) -> str:
    """Return the name under which Gymnasium knows a scenario."""
    return f"codriving/{scenario}-v0"


def register_scenarios(config_dir: str | Path | None = None) -> None:
    """Tell Gymnasium of every scenario; again does no harm."""
    import gymnasium

    from codriving.config.choices import choices

    ours = choices("scenario")
    folder = None if config_dir is None else Path(config_dir)
    for name in choices("scenario", folder):
        if env_id(name) in gymnasium.registry:
            continue
        settings: dict[str, object] = {"name": name}
        if name not in ours:
            settings["config_dir"] = str(folder)
        gymnasium.register(env_id(name), ENTRY_POINT, kwargs=settings)


def offer() -> None:
    """Register now if Gymnasium is there, and otherwise as soon as somebody imports it.

    Gymnasium no longer looks for plugins, and importing it takes longer than all that `codriving --help` does.
    """
    if GYMNASIUM in sys.modules:
        register_scenarios()
    elif not any(isinstance(finder, _WhenImported) for finder in sys.meta_path):
        sys.meta_path.insert(0, _WhenImported())


class _WhenImported:
    """Finds Gymnasium where it is, and registers our environments after it has been loaded."""

    def __init__(self) -> None:
        self._looking = False

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: "ModuleType | None" = None
    ) -> "ModuleSpec | None":
        if fullname != GYMNASIUM or self._looking:
            return None
        from importlib.util import find_spec

        self._looking = True
        try:
            spec = find_spec(fullname)
        finally:
            self._looking = False
        loader = None if spec is None else spec.loader
        if loader is None:
            return spec
        load = loader.exec_module

        def exec_module(module: "ModuleType") -> None:
            load(module)
            # The loader is Gymnasium's own: it is left as it was.
            del loader.exec_module
            if self in sys.meta_path:
                sys.meta_path.remove(self)
            register_scenarios()

        loader.exec_module = exec_module  # type: ignore[method-assign]
        return spec
