"""Partners who were expected to brake and do not: whoever is seen not to play the game is not expected to."""

BRAKES = 0.5
"""How much slower somebody must have become to count as braking [m/s]."""


class Stubborn:
    """Remembers of whom it was expected to brake, and how fast it was then."""

    def __init__(self) -> None:
        self._speeds: dict[tuple[str, str], float] = {}

    def expected_to_brake(self, ego: str, other: str, speed: float) -> None:
        """Note that somebody should brake from now on.

        Args:
            speed: Its speed now [m/s].
        """
        self._speeds[ego, other] = speed

    def keeps_on(self, ego: str, other: str, speed: float) -> bool:
        """Whether somebody was expected to brake before and has not; whoever does is taken at its word again.

        Args:
            speed: Its speed now [m/s].
        """
        before = self._speeds.get((ego, other))
        if before is None:
            return False
        if speed <= before - BRAKES:
            del self._speeds[ego, other]
            return False
        return True
