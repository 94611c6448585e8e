"""Roads and vehicles of highway-env without its environments, which bring Matplotlib and pandas with them."""

import sys
from importlib import import_module
from importlib.util import LazyLoader, find_spec, module_from_spec

PARTS = ("highway_env.road.regulation", "highway_env.vehicle.behavior")  # They import every other one that is used


def import_parts() -> None:
    """Import the parts; the package itself, and so its environments, with the first use of it from elsewhere."""
    spec = None if "highway_env" in sys.modules else find_spec("highway_env")
    if spec is None or spec.loader is None:
        return
    package = sys.modules[spec.name] = module_from_spec(spec)
    for part in PARTS:
        import_module(part)
    # From here on whatever looks at the package, ``import highway_env`` included, runs its own code first.
    spec.loader = LazyLoader(spec.loader)
    spec.loader.exec_module(package)
