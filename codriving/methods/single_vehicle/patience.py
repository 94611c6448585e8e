"""How long everybody has been waiting: whoever has waited long enough may start into an empty zone."""

from codriving.reasoning.sharing.tracking import STANDING


class Patience:
    """Remembers since when each CAV stands."""

    def __init__(self) -> None:
        self._since: dict[str, float] = {}

    def waited(self, name: str, speed: float, time: float) -> float:
        """Return how long a CAV has been standing, now that its speed is known [s].

        Args:
            speed: Its speed [m/s].
            time: Simulated time [s].
        """
        if speed >= STANDING:
            self._since.pop(name, None)
            return 0.0
        return time - self._since.setdefault(name, time)
