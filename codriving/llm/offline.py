"""``llm=offline``: no model at all; the built-in rules reason, and every table says so."""


class Offline:
    """The built-in rule reasoner; no network, no key, deterministic."""

    name = "rules"
    max_concurrency = 1

    def chat(self) -> None:
        """Return nothing: there is no model to ask."""
