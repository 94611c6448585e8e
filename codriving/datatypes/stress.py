"""An axis of stress: what is made worse, level by level."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class StressLevel:
    """One level: a value, and the ``key=value`` tokens that set it."""

    value: float | str
    overrides: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class StressAxis:
    """What is varied, from the mildest level on."""

    key: str  # What the command line calls it
    name: str
    unit: str
    sentence: str  # What its YAML says of it
    levels: tuple[StressLevel, ...]

    @property
    def labels(self) -> tuple[str, ...]:
        """Each level with its unit."""
        values = [level.value if isinstance(level.value, str) else f"{level.value:g}" for level in self.levels]
        return tuple(f"{value} {self.unit}".strip() for value in values)

    @property
    def title(self) -> str:
        """What is varied, with its unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    @property
    def places(self) -> tuple[float, ...]:
        """Where each level lies between the first one, 0, and the last one, 1; names lie at equal distances."""
        values = [index if isinstance(level.value, str) else level.value for index, level in enumerate(self.levels)]
        return tuple((value - values[0]) / (values[-1] - values[0]) for value in values)
