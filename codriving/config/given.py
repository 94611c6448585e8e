"""Methods that are given as objects or classes: offered under a name by which a config can ask for them."""

import inspect
import pickle
import sys
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from codriving.config.choices import taking_part
from codriving.config.object_identity import identity_of, name_of
from codriving.datatypes import Method, OrderOfCavs
from codriving.errors import ConfigError


@dataclass(frozen=True)
class Given:
    """A method, or the rule of one that orders, of the user's."""

    thing: Any  # The object, or its class
    identity: str  # SHA-256 of what it is and does
    is_rule: bool

    @classmethod
    def of(cls, thing: object) -> "Given":
        """Look at what was given.

        Raises:
            ConfigError: If it is neither a method nor an order rule, or cannot be told from others.
        """
        made = thing if isinstance(thing, type) else type(thing)
        if not issubclass(made, Method | OrderOfCavs):
            raise ConfigError(
                "a method is a name, or an object or a class that inherits from codriving.datatypes.Method or from "
                f"codriving.ordering.OrderRule, got {thing!r:.100}"
            )
        if isinstance(thing, type) and (missing := getattr(thing, "__abstractmethods__", None)):
            raise ConfigError(f"{name_of(thing)} lacks {', '.join(sorted(missing))}; every method has to have it")
        return cls(thing, identity_of(thing), issubclass(made, OrderOfCavs))

    @property
    def name(self) -> str:
        """What stands in the manifest in the place of the name of a YAML."""
        return f"{name_of(self.thing)}@{self.identity[:12]}"

    @property
    def base(self) -> str:
        """The name of a method of ours whose config it is put into."""
        # The first baseline is a rule with an executor, and an order rule takes the place of that rule.
        return taking_part("baselines")[0] if self.is_rule else "codriving"

    def offer(self) -> str:
        """Let configs of this process ask for it; gives its ``_target_``."""
        name = f"{name_of(self.thing)}_{self.identity[:12]}"
        cls = self.thing if isinstance(self.thing, type) else type(self.thing)
        own: dict[str, Any] = {"__module__": __name__}
        if isinstance(self.thing, type):
            own["__signature__"] = _signature(cls)
        else:
            own |= {"__signature__": inspect.Signature(), "__new__": lambda _: _copied(self.thing)}
        globals()[name] = made = type(cls)(name, (cls,), own)
        made.__name__ = name_of(self.thing)  # In what is said of it
        return f"{__name__}.{name}"

    def put_into(self, config: dict[str, Any], choices: dict[str, str]) -> tuple[dict[str, Any], dict[str, str]]:
        """Put it into a composed config of its base, and its name among the choices."""
        node = {"_target_": self.offer()}
        method = {**config["method"], "rule": node} if self.is_rule else node
        return {**config, "method": method}, {**choices, "method": self.name}

    @property
    def stays(self) -> str:
        """Why no other process could make it; empty if one can."""
        cls, name = self.thing if isinstance(self.thing, type) else type(self.thing), name_of(self.thing)
        if cls.__module__ == "__main__":
            return f"the class {name} is of a notebook or script"
        try:
            pickle.dumps(self.thing)
        except Exception as error:
            return f"{name} cannot be pickled ({error})"
        return "" if getattr(sys.modules.get(cls.__module__), "__spec__", None) else f"no module has the class {name}"


def _signature(cls: type) -> inspect.Signature:
    """The arguments of a class, with classes for annotations that are texts, where that can be."""
    try:
        return inspect.signature(cls, eval_str=True)
    except NameError:
        return inspect.signature(cls)


def _copied(thing: Any) -> Any:  # noqa: ANN401 - any object
    """A copy for each cell, so that none depends on what was driven before."""
    try:
        return deepcopy(thing)
    except Exception as error:
        raise ConfigError(f"{name_of(thing)} cannot be copied ({error}); give its class, which is made anew") from error
