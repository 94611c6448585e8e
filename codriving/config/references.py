"""Plain references between keys, ``${output}`` and the like, and no other interpolation."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from codriving.config.schema import texts
from codriving.errors import ConfigError

# Whatever begins like an interpolation and is not the name of a key, from the root or (with dots before it) from here.
_OTHER = re.compile(r"\$\{(?!\s*\.*\w+(?:\.\w+)*\s*\})")
_ENVIRONMENT = re.compile(r"\$\{\s*oc\.env\b")


def check_references(raw: object, file: Path | None = None) -> None:
    """Refuse what reads more than this config, above all environment variables, since a config is written to disk.

    Args:
        raw: A config whose references are not resolved yet.
        file: Where it is from, for the message.
    """
    for key, text in texts(raw):
        where = f"{file}: {key}" if file else key
        if _ENVIRONMENT.search(text):
            raise ConfigError(
                f"{where} reads an environment variable, which would be written to the run folder; "
                f"a secret is given by the name of its variable, anything else by its value ({key}=$NAME)"
            )
        if _OTHER.search(text):
            raise ConfigError(
                f"{where} must not hold an interpolation other than a plain reference to a key, such as "
                "${output}, since a config may read nothing but itself; write the value"
            )


@contextmanager
def no_resolvers() -> Iterator[None]:
    """Leave OmegaConf no function that an interpolation could call, also in lists of defaults, which Hydra resolves."""
    from omegaconf.basecontainer import BaseContainer

    kept = BaseContainer._resolvers
    BaseContainer._resolvers = {}
    try:
        yield
    finally:
        BaseContainer._resolvers = kept
