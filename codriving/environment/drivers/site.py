"""A site: a place whose drivers are of a mix of their own, which stays as it is from one episode to the next."""

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from codriving.environment.drivers.style import DriverMix
from codriving.errors import require, require_range

_NAME = re.compile(r"[A-Za-z0-9][\w.-]{0,31}", re.ASCII)


@dataclass(frozen=True, slots=True)
class SiteMix(DriverMix):
    """A mix whose shares are drawn once, from the name of the site alone, around the ``shares`` that are given.

    Args:
        site: Name or number of the site.
        evenness: Sum of the parameters of the Dirichlet distribution that the shares are drawn from: small, and most
            drivers of a site are of one style; large, and all sites are alike.
    """

    site: str | int
    evenness: float

    def __post_init__(self) -> None:
        DriverMix.__post_init__(self)
        found = _NAME.fullmatch(str(self.site))
        require(found is not None, f"drivers.site must be a name of letters and digits, got {self.site!r:.80}")
        require_range("drivers.evenness", self.evenness, 0.1, 1000)

    @property
    def weights(self) -> Mapping[str, float]:
        """Shares of the styles at the site."""
        key = np.random.SeedSequence(entropy=0, spawn_key=(3, *str(self.site).encode()))
        named = {name: share for name, share in self.shares.items() if share > 0}
        parameters = [self.evenness * share / sum(named.values()) for share in named.values()]
        # Gamma variates over their sum are Dirichlet's; a share that is too small for a number is none.
        drawn = np.random.default_rng(key).gamma(parameters) + 1e-9
        return dict(zip(named, (drawn / drawn.sum()).round(4).tolist(), strict=True))
