"""A `_target_` to the class it names, and nothing but classes of ours and of the user's plugins."""

import importlib
from collections.abc import Sequence

from codriving.config.moved import moved_imports, new_place
from codriving.errors import ConfigError

OURS = "codriving"


def find_class(target: object, key: str, plugins: Sequence[str] = ()) -> type:
    """Import the class that a config node names."""
    if not isinstance(target, str) or "." not in target:
        raise ConfigError(f"{key}._target_ must be the full name of a class, got {target!r}")
    allowed = (OURS, *plugins)
    if not _within(target, allowed):
        raise ConfigError(
            f"{key}._target_ may name classes of {', '.join(allowed)}, got {target}; "
            f"list other packages under plugins, in the same file as plugins: [{target.partition('.')[0]}]"
        )
    module_name, _, class_name = target.rpartition(".")
    try:
        module = importlib.import_module(module_name)
    except ImportError as err:
        if said := moved_imports(err):
            raise ConfigError(f"{key}._target_ is {target}, but {said}") from err
        # A package that the user has not installed is for them to mend; one that is missing inside it is a bug there.
        if err.name is None or not (module_name == err.name or module_name.startswith(f"{err.name}.")):
            raise
        if _within(target, (OURS,)) and (place := new_place(class_name)):
            raise ConfigError(f"{key}._target_ is {target}, which is {place} since release 0.2; write that") from err
        raise ConfigError(
            f"{key}._target_ is {target}, but there is no module {err.name}; "
            "install it, or put it beside the folder that --config-dir names"
        ) from err
    # A name that a module merely imported (a function of the standard library, say) is not one that it offers.
    found = vars(module).get(class_name)
    if isinstance(found, type) and _within(found.__module__, allowed):
        return found
    place = new_place(class_name) if _within(target, (OURS,)) else None
    hint = f"; it is {place} since release 0.2" if place else ""
    raise ConfigError(f"{key}._target_ is {target}, but {module_name} has no class {class_name}{hint}")


def _within(name: str, packages: Sequence[str]) -> bool:
    return any(name == package or name.startswith(f"{package}.") for package in packages)
