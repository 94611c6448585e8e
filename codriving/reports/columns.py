"""A table is a list of columns; each says once what it is called, where its value comes from and how it reads."""

import csv
import io
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Generic, TypeAlias, TypeVar

if TYPE_CHECKING:
    from pandas import DataFrame

T = TypeVar("T")

Value: TypeAlias = str | int | float | None  # What stands in a cell of a table; None where something is not defined

Row: TypeAlias = Mapping[str, Value]  # One row, by key of the column


def plain(value: Value) -> str:
    """Write a value as it is; nothing where it is not defined."""
    return "" if value is None else str(value)


@dataclass(frozen=True)
class Column(Generic[T]):
    """One column of a table whose rows are made of `T`."""

    key: str  # Its name in the CSV
    value: Callable[[T], Value]  # Gives its value; None where it is not defined
    head: str = ""  # Its head on the screen and in Markdown; empty where it is in neither
    text: Callable[[Value], str] = plain  # Writes its value for the screen and Markdown
    words: bool = False  # Whether it holds words, which stand left and are no numbers
    csv: bool = True  # Whether it is in the CSV
    page: bool = True  # Whether it is in Markdown; what differs from run to run is on the screen alone
    sparse: bool = False  # Whether it is shown only where a row has a value other than 0
    rank: int = 0  # When it gives way on a narrow terminal: the highest first, 0 never
    brief: tuple[str, str] | None = None  # Head of its short form there, and the text before which a cell is cut then
    swept: bool = False  # Whether it is of a swept key, which may take numbers as well as words

    def of(self, part: Callable[[Any], T | None], key: str = "", head: str = "") -> "Column[Any]":
        """The same column in a table whose rows have such a part; not defined for those that lack it."""

        def value(item: object) -> Value:
            found = part(item)
            return None if found is None else self.value(found)

        return replace(self, key=key or self.key, value=value, head=head or self.head)


@dataclass(frozen=True, slots=True)
class Table:
    """Columns and rows; a row holds the values of what is shown, too."""

    columns: tuple[Column[Any], ...]
    rows: tuple[Row, ...]

    @property
    def keys(self) -> tuple[str, ...]:
        """The columns of the CSV."""
        return tuple(column.key for column in self.columns if column.csv)

    def csv(self) -> str:
        """Write it as CSV: undefined is empty, numbers have six significant digits."""
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(self.keys)
        writer.writerows([_csv_text(row.get(key)) for key in self.keys] for row in self.rows)
        return out.getvalue()

    def frame(self) -> "DataFrame":
        """Give it as a data frame; numbers that are not defined are NaN."""
        from pandas import DataFrame, to_numeric

        frame = DataFrame([[row.get(key) for key in self.keys] for row in self.rows], columns=self.keys)
        for column in self.columns:
            if column.csv and column.swept:
                with suppress(ValueError, TypeError):
                    frame[column.key] = to_numeric(frame[column.key])
            elif column.csv and not column.words:
                frame[column.key] = to_numeric(frame[column.key])
        return frame


def table(columns: Sequence[Column[Any]], items: Iterable[Any]) -> Table:
    """Make a table with a row for each item."""
    return Table(tuple(columns), tuple({column.key: column.value(item) for column in columns} for item in items))


def swept_columns(keys: Iterable[str], words: bool = True) -> list[Column[Any]]:
    """The columns of swept keys, of what has a mapping `swept`."""

    def column(key: str) -> Column[Any]:
        return Column(key, lambda item: item.swept.get(key), key, words=words, swept=True)

    return [column(key) for key in keys]


def mean(values: Sequence[float]) -> float | None:
    """Give the mean, by exact summation the same in any order; None of no values."""
    return math.fsum(values) / len(values) if values else None


def share(part: int, whole: int) -> float | None:
    """Give a rate; None of none."""
    return part / whole if whole else None


def _csv_text(value: Value) -> str:
    # Adding zero turns -0.0 into 0.0.
    return format(value + 0.0, ".6g") if isinstance(value, float) else plain(value)
