"""Hydra's ``compose`` for tests: the same choices of YAMLs are composed once, and values are set in a copy.

Hydra, too, first composes what the groups are set to and then applies the values, by the function that is called here.
"""

import copy
from collections.abc import Callable, Sequence
from typing import Any

from hydra._internal.config_loader_impl import ConfigLoaderImpl
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import OverrideType
from hydra.errors import OverrideParseException

CHOICE, VALUE = OverrideType.CHANGE, OverrideType.FORCE_ADD
"""How the program writes ``scenario=merge`` and ``++scenario.cavs=4``."""


def composed_once(compose: Callable[..., Any]) -> Callable[..., Any]:
    """Wrap Hydra's function."""
    known: dict[tuple[str, ...], Any] = {}
    parser = OverridesParser.create()

    def once(config_name: str, overrides: Sequence[str], **more: Any) -> Any:
        path, *tokens = overrides
        try:
            parsed = parser.parse_overrides(tokens)
        except OverrideParseException:
            return compose(config_name, overrides=overrides, **more)
        # Files of a folder of the user's are the test's, which may write them anew.
        if path.count("file://") != 1 or not all(token.type in (CHOICE, VALUE) for token in parsed):
            return compose(config_name, overrides=overrides, **more)
        values = [token for token in parsed if token.type is VALUE]
        chosen = [path, *(token.input_line for token in parsed if token.type is CHOICE)]
        key = (config_name, *chosen)
        if key not in known:
            known[key] = compose(config_name, overrides=chosen, **more)
        config = copy.deepcopy(known[key])
        ConfigLoaderImpl._apply_overrides_to_config(values, config)
        return config

    return once
