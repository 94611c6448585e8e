"""What ``--cfg`` prints."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from codriving.config.sweep import Point


def print_configs(points: "Sequence[Point]", config_dir: Path | None) -> None:
    """Print the composed config of every cell, once all of them are known to be valid.

    Raises:
        ConfigError: If one of them cannot be used.
    """
    from codriving.config.show import show
    from codriving.experiment.configs import cell_name, composed, validated

    configs = composed(points, config_dir)
    validated(points, configs)
    for index, (point, config) in enumerate(zip(points, configs, strict=True)):
        if len(points) > 1:
            print(f"---\n# cell {index + 1} of {len(points)}: {cell_name(point)}")
        print(show(config), end="")
