"""Every text of a config, wherever it stands."""

from collections.abc import Iterator, Mapping


def texts(node: object, key: str = "") -> Iterator[tuple[str, str]]:
    """Yield every text with its dotted key."""
    if isinstance(node, Mapping):
        for name, value in node.items():
            yield from texts(value, f"{key}.{name}" if key else str(name))
    elif isinstance(node, list):
        for index, value in enumerate(node):
            yield from texts(value, f"{key}.{index}")
    elif isinstance(node, str):
        yield key, node
