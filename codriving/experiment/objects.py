"""A resolved config to the objects that drive; done once a process and cell."""

import gc
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from codriving.config import Given, asks_for, build, targets
from codriving.datatypes import ActionFilter, CaseMemory, Communication, Method, Model, Simulator, ThinkingTime
from codriving.experiment.scoring import scorers_of
from codriving.experiment.worker import Objects


def model_of(config: Mapping[str, Any]) -> Model | None:
    """Build the language model that the method of a config asks for; None if it asks for none."""
    plugins = config["plugins"]
    return build(config["llm"], Model, "llm", plugins) if asks_for(config["method"], Model, plugins) else None


def memory_of(config: Mapping[str, Any]) -> CaseMemory | None:
    """Build the memory that the method of a config asks for; None if it asks for none, or none is chosen."""
    node, plugins = config["memory"], config["plugins"]
    if node is None or not asks_for(config["method"], CaseMemory, plugins):
        return None
    return build(node, CaseMemory, "memory", plugins)


def consults(config: Mapping[str, Any]) -> bool:
    """Tell whether what a config describes asks a language model, one that stands for it, or a server for vectors."""
    llm, memory = model_of(config), memory_of(config)
    return (llm is not None and llm.chat() is not None) or (memory is not None and memory.asks)


def make_method(config: Mapping[str, Any], llm: Model | None, memory: CaseMemory | None) -> Method:
    """Build the method of a config, handed what it asks for, with filter, thinking time and channel around it."""
    plugins = config["plugins"]
    method = build(config["method"], Method, "method", plugins, {Model: llm, CaseMemory: memory})
    if (filtered := config.get("filter")) is not None:
        method = build(filtered, ActionFilter, "filter", plugins).around(method)
    method = thinking_of(config).around(method, llm)
    return communication_of(config).between(method, [part for part in (llm, memory) if part])


def communication_of(config: Mapping[str, Any]) -> Communication:
    """Build what says how the CAVs of a config hear of one another."""
    node = config.get("v2x")
    return Communication() if node is None else build(node, Communication, "v2x", config["plugins"])


def thinking_of(config: Mapping[str, Any]) -> ThinkingTime:
    """Build what says how long the method of a config thinks."""
    node = config.get("thinking")
    return ThinkingTime() if node is None else build(node, ThinkingTime, "thinking", config["plugins"])


def make_objects(config: Mapping[str, Any], llm: Model | None = None) -> Objects:
    """Build the objects of a config; llm and memory are built once."""
    llm, memory = llm or model_of(config), memory_of(config)
    environment = build(config["environment"], Simulator, "environment", config["plugins"])
    return Objects(environment, make_method(config, llm, memory), scorers_of(config), llm, memory)


@dataclass(frozen=True)
class BuildObjects:
    """Builds the objects of a cell from its name; it travels to the workers, so it holds plain values only."""

    configs: Mapping[str, Mapping[str, Any]]

    def __call__(self, cell: str) -> Objects:
        """Build them."""
        return _settled(make_objects(self.configs[cell]))


@dataclass(frozen=True)
class BuildWithGiven:
    """Builds the objects of cells of which some have a method of the user's; each process is offered these."""

    given: tuple[Given, ...]
    configs: Mapping[str, Mapping[str, Any]]

    def __call__(self, cell: str) -> Objects:
        """Build them."""
        for one in self.given:
            one.offer()
        return _settled(make_objects(self.configs[cell]))


def _settled(objects: Objects) -> Objects:
    """Once a process, take what is there from the garbage collector, modules above all.

    A full collection looks through all of it, for 50 ms in the middle of a decision.
    """
    if not gc.get_freeze_count():
        gc.freeze()
    return objects


@contextmanager
def given_back() -> Iterator[None]:
    """Give back to the garbage collector what was taken from it meanwhile: the process may have other work to do."""
    taken = gc.get_freeze_count()
    try:
        yield
    finally:
        if not taken:
            gc.unfreeze()


def modules_to_preload(configs: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
    """List the modules that all workers need, so that they are imported once and not once a worker.

    Only ours: a user's module that fails to import must fail where it is used, with its own message.
    """
    used = {target.rpartition(".")[0] for config in configs for target in targets(config)}
    ours = sorted(module for module in used if module.startswith("codriving."))
    return (__name__, *ours)
