"""Numbers, reasoners and methods as people read them; what is not defined is empty or a dash."""

from collections.abc import Iterable, Sequence

from codriving.reports.columns import Value

# What a method adds to its name if built-in rules stand in for its language model.
WITH_RULES = "-rule"


def percent(value: Value) -> str:
    """Write a rate in percent."""
    return f"{100 * value:.3g} %" if isinstance(value, int | float) else ""


def fixed(value: Value, digits: int = 1) -> str:
    """Write a number with so many decimals; one that is rounded to zero has no sign."""
    return f"{round(value, digits) + 0.0:.{digits}f}" if isinstance(value, int | float) else ""


def two_digits(value: Value) -> str:
    """Write a number with two decimals."""
    return fixed(value, 2)


def signed(value: Value, digits: int = 2) -> str:
    """Write a difference with its sign; one that is rounded to zero has none."""
    if not isinstance(value, int | float):
        return ""
    rounded = round(value, digits)
    return f"{rounded:+.{digits}f}" if rounded else f"{0.0:.{digits}f}"


def three(*numbers: Value) -> str:
    """Write mean, maximum and minimum; a dash where one is not defined."""
    return " / ".join(fixed(number) or "-" for number in numbers)


def interval_text(limits: Sequence[Value]) -> str:
    """Write the interval of a rate."""
    low, high = map(percent, limits)
    return f"{low.removesuffix(' %')} to {high}" if low else ""


def milliseconds(seconds: float | None) -> str:
    """Write a time; a dash where it is lost."""
    return "-" if seconds is None else fixed(seconds * 1000)


def reasoner_text(reasoner: Value) -> str:
    """Name what reasons, so that rules are not taken for a model."""
    return f"{reasoner} (llm=offline)" if reasoner == "rules" else str(reasoner)


def short_names(reasoners: Iterable[str]) -> dict[str, str]:
    """Name reasoners in the rows of a table: without the providers that all models have in common."""
    names = list(dict.fromkeys(reasoners))
    short = {name: name.split("/") for name in names if name not in ("rules", "none")}
    while short and len({parts[0] for parts in short.values()}) == 1 and all(parts[1:] for parts in short.values()):
        short = {name: parts[1:] for name, parts in short.items()}
    return {name: "/".join(short.get(name, [name])) for name in names}


def title(what: str, scenarios: Iterable[Value], reasoners: Iterable[Value], metrics: str) -> str:
    """Say what a table or figure shows, and by which definitions where they are not ours."""
    names = [what, ", ".join(dict.fromkeys(map(str, scenarios)))]
    reasoner = ", ".join(dict.fromkeys(map(reasoner_text, reasoners)))
    return " - ".join(filter(None, names)) + f" - reasoner: {reasoner}{metrics_text(metrics)}"


def metrics_text(metrics: str) -> str:
    """Name the definitions by which was measured, where they are not ours."""
    return "" if metrics == "standard" else f" - metrics: {metrics}"


def place_of(method: str, reasoner: str) -> str:
    """Return the method that something is in a table: where rules reason, its name without the mark of a stand-in."""
    return method.removesuffix(WITH_RULES) if reasoner == "rules" else method


def stand_in_notes(rows: Iterable[tuple[Value, Value]]) -> list[str]:
    """Say of every method whose language model rules stand in for that it is not that method.

    Args:
        rows: Method and reasoner of each row.
    """
    named = {str(method): place_of(str(method), str(reasoner)) for method, reasoner in rows}
    return [
        f"{n}: built-in rules in the place of {place}'s language model; it is not that method."
        for n, place in named.items()
        if place != n
    ]
