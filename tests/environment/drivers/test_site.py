"""A site has a mix of its own, which its name alone tells; over many sites the shares are those that were given."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.parts import Drivers
from codriving.environment.drivers.site import SiteMix
from codriving.environment.drivers.style import DriverMix
from codriving.errors import ConfigError


def at(*overrides: str) -> SiteMix:
    made = build(compose(["drivers=site", *overrides])["drivers"], Drivers, "drivers")
    assert isinstance(made, SiteMix)
    return made


def several(mix: SiteMix, sites: range) -> list[Mapping[str, float]]:
    return [replace(mix, site=site).weights for site in sites]


def test_a_site_keeps_its_mix_whatever_the_seed() -> None:
    six = at("drivers.site=6")
    assert six.weights == {
        "attentive": 0.2676, "aggressive": 0.24, "hesitant": 0.0361, "nonyielding": 0.4455, "distracted": 0.0109,
    }  # fmt: skip
    assert at("drivers.site='6'").weights == six.weights
    for first in (10_000, 20_000):
        styles = Counter(six.draw(seed, "HDV1").style for seed in range(first, first + 2000))
        assert styles["nonyielding"] / 2000 == pytest.approx(0.4455, abs=0.04)


def test_sites_differ_and_have_the_given_shares_on_average() -> None:
    sites = several(at(), range(1, 200))
    mean = {style: np.mean([site[style] for site in sites]) for style in sites[0]}
    assert mean == pytest.approx(
        {"attentive": 0.3, "aggressive": 0.25, "hesitant": 0.1, "nonyielding": 0.2, "distracted": 0.15}, abs=0.06
    )
    assert sum(max(site.values()) > 0.5 for site in sites) > 80
    even = several(at("drivers.evenness=1000"), range(1, 30))
    assert max(site["attentive"] for site in even) < 0.36
    assert min(site["attentive"] for site in even) > 0.24


def test_a_driver_of_a_style_is_the_same_at_every_site() -> None:
    rough = build(compose(["drivers=rough"])["drivers"], Drivers, "drivers")
    assert isinstance(rough, DriverMix)
    here = at("drivers.site=south")
    pairs = [(rough.draw(seed, "HDV1"), here.draw(seed, "HDV1")) for seed in range(300)]
    same = [(one, other) for one, other in pairs if one.style == other.style]
    assert 50 < len(same) < 250
    assert all(one == other for one, other in same)


def test_what_cars_expect_of_drivers_tells_nothing_of_the_site() -> None:
    assert {replace(at(), site=site).acceleration for site in range(1, 12)} == {3.0}
    assert set(at("drivers.shares.hesitant=0").weights) == {"attentive", "aggressive", "nonyielding", "distracted"}


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("drivers.site=''", "drivers.site must be a name of letters and digits, got ''"),
        ("drivers.site='a b'", "drivers.site must be a name of letters and digits, got 'a b'"),
        ("drivers.evenness=0", "drivers.evenness must be 0.1 to 1000, got 0"),
        ("drivers.shares.polite=1", "drivers.shares.polite is of no style"),
    ],
)
def test_what_is_no_site_is_refused(override: str, message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        at(override)
