"""Numbers that change along a training, counted over all of it and not over an episode."""

from dataclasses import dataclass

from codriving.errors import ConfigError


@dataclass(frozen=True, slots=True)
class Linear:
    """A number that goes from one value to another in a straight line, and then stays.

    Raises:
        ConfigError: If ``over`` is not positive.
    """

    start: float
    end: float
    over: int

    def __post_init__(self) -> None:
        if self.over < 1:
            raise ConfigError(f"over must be 1 or more, got {self.over}")

    def at(self, decisions: int) -> float:
        """Return the value after some decisions."""
        share = min(max(decisions, 0) / self.over, 1.0)
        return self.start + share * (self.end - self.start)
