"""The key of a server, read where and when it is used and kept nowhere."""

import os
from dataclasses import dataclass

from codriving.errors import ModelError


@dataclass(frozen=True, slots=True)
class Key:
    """Where a key is found.

    Attributes:
        variable: Name of the environment variable; None if no key is sent.
        api_base: Address of the server; None for the provider's own.
    """

    variable: str | None
    api_base: str | None

    def read(self) -> str | None:
        """Return the key.

        Raises:
            ModelError: If it is missing or can't be one.
        """
        if self.variable is None:
            if self.api_base is None:
                raise ModelError(
                    "llm.api_base must be the address of your server, for instance http://127.0.0.1:8000/v1, got null; "
                    "only with llm.api_key_env can it be left out"
                )
            return None
        key = os.environ.get(self.variable, "").strip()
        if not key:
            raise ModelError(
                f"{self.variable} is not set; put the key of the model into that environment variable, or set "
                "llm.api_key_env to the name of another one (null if the server wants no key)"
            )
        if not all("!" <= character <= "~" for character in key):
            raise ModelError(f"{self.variable} holds characters that no key has; set it to the key alone")
        return key
