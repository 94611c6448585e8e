"""A resolved config to the objects that drive; done once a process and cell."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from codriving.config.build import TARGET, build
from codriving.experiment.worker import Objects


@dataclass(frozen=True)
class BuildObjects:
    """Builds the objects of a cell from its name; it travels to the workers, so it holds plain values only."""

    configs: Mapping[str, Mapping[str, Any]]

    def __call__(self, cell: str) -> Objects:
        """Build them.

        Raises:
            ConfigError: If one of them cannot be built.
        """
        config = self.configs[cell]
        plugins = config["plugins"]
        scenario = build(config["scenario"], plugins, "scenario")
        return Objects(
            environment=build({**config["environment"], "scenario": scenario}, plugins, "environment"),
            method=build(config["method"], plugins, "method"),
            metrics=build(config["metrics"], plugins, "metrics"),
        )


def modules_to_preload(configs: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
    """List the modules that all workers need, so that they are imported once and not once a worker.

    Only ours: a user's module that fails to import must fail where it is used, with its own message.
    """
    used = {target.rpartition(".")[0] for config in configs for target in _targets(config)}
    ours = {module for module in used if module.startswith("codriving.")}
    return ("codriving.experiment.processes", __name__, *sorted(ours))


def _targets(node: object) -> Iterator[str]:
    """Every class that a config names."""
    if isinstance(node, Mapping):
        for name, value in node.items():
            if name == TARGET and isinstance(value, str):
                yield value
            else:
                yield from _targets(value)
    elif isinstance(node, list):
        for value in node:
            yield from _targets(value)
