"""Numbers of a row as people read them; what is not defined is empty or a dash."""

from codriving.reports.rows import Row, Value


def percent(value: Value) -> str:
    """Write a rate in percent."""
    return f"{100 * value:.3g} %" if isinstance(value, int | float) else ""


def fixed(value: Value, digits: int = 1) -> str:
    """Write a number with so many decimals."""
    return f"{value + 0.0:.{digits}f}" if isinstance(value, int | float) else ""


def signed(value: Value, digits: int = 2) -> str:
    """Write a difference with its sign; one that is rounded to zero has none."""
    if not isinstance(value, int | float):
        return ""
    rounded = round(value, digits)
    return f"{rounded:+.{digits}f}" if rounded else f"{0.0:.{digits}f}"


def three(numbers: Row, what: str) -> str:
    """Write mean, maximum and minimum; a dash where one is not defined.

    Args:
        what: Beginning of its columns, for instance ``pet``.
    """
    return " / ".join(fixed(numbers.get(f"{what}_{which}")) or "-" for which in ("mean", "max", "min"))


def interval_text(row: Row) -> str:
    """Write the interval of a success rate."""
    low, high = percent(row["success_low"]), percent(row["success_high"])
    return f"{low} to {high}" if low else ""


def episodes_text(row: Row) -> str:
    """Write how many episodes there are, and how many of them were driven to an end where some were not."""
    return str(row["episodes"]) if row["completed"] == row["episodes"] else f"{row['completed']}/{row['episodes']}"


def reasoner_text(reasoner: str) -> str:
    """Name who reasons, so that nobody takes rules for a model."""
    return f"{reasoner} (llm=offline)" if reasoner == "rules" else reasoner


def metrics_text(metrics: str) -> str:
    """Name the definitions by which was measured, where they are not ours."""
    return "" if metrics == "standard" else f" - metrics: {metrics}"
