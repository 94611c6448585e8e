"""Axes of stress: those of ours, and files of a user's that are refused in a line."""

import re
from pathlib import Path

import pytest

from codriving.config.build import build, validate
from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.config.stress import stress_axis
from codriving.datatypes.stress import StressAxis, StressLevel
from codriving.environment.drivers.style import DriverMix
from codriving.errors import ConfigError

GOOD = """# How many CAVs there are.
name: CAVs
unit: ""
levels:
  - value: 2
    set: [scenario.cavs=2]
  - value: 6
    set: [scenario.cavs=6]
"""


def own(folder: Path, text: str) -> Path:
    (folder / "stress").mkdir()
    (folder / "stress" / "mine.yaml").write_text(text)
    return folder


@pytest.mark.parametrize("name", choices("stress"))
def test_ours_have_four_levels_that_can_be_driven(name: str) -> None:
    axis = stress_axis(name)
    assert len(axis.levels) == 4
    configs = [compose(level.overrides) for level in axis.levels]
    for config in configs:
        validate(config)
    assert all(one != other for index, one in enumerate(configs) for other in configs[:index])


def test_an_axis_of_a_user_is_one_more(tmp_path: Path) -> None:
    levels = (StressLevel(2.0, ("scenario.cavs=2",)), StressLevel(6.0, ("scenario.cavs=6",)))
    assert stress_axis("mine", own(tmp_path, GOOD)) == StressAxis(
        "mine", "CAVs", "", "How many CAVs there are.", levels
    )
    assert set(choices("stress", tmp_path)) == {*choices("stress"), "mine"}


def test_levels_of_one_axis_of_ours_are_shares_of_drivers_who_never_give_way() -> None:
    """A driver who gives way at no level is the same at the next one; the others are as they were."""
    mixes = [build(compose(level.overrides)["drivers"], DriverMix, "drivers") for level in stress_axis("humans").levels]
    drawn = [[mix.draw(seed, "HDV0") for seed in range(20_000, 21_000)] for mix in mixes]
    rude = [{k for k, driver in enumerate(drivers) if driver.gives_way == "never"} for drivers in drawn]
    assert [round(len(found) / 1000, 1) for found in rude] == [0.0, 0.1, 0.2, 0.3]
    assert rude[0] < rude[1] < rude[2] < rude[3]
    assert all(drawn[0][k] == drawn[3][k] for k in range(1000) if k not in rude[3])


@pytest.mark.parametrize(
    ("values", "places", "labels"),
    [
        ((0.0, 0.3, 1.0, 2.0), (0.0, 0.15, 0.5, 1.0), ("0 m", "0.3 m", "1 m", "2 m")),
        ((300.0, 100.0, 30.0), (0.0, 200 / 270, 1.0), ("300 m", "100 m", "30 m")),
        (("good", "urban", "poor"), (0.0, 0.5, 1.0), ("good m", "urban m", "poor m")),
    ],
)
def test_levels_lie_where_their_values_say(
    values: tuple[float | str, ...], places: tuple[float, ...], labels: tuple[str, ...]
) -> None:
    axis = StressAxis("x", "noise", "m", "Noise.", tuple(StressLevel(value, ()) for value in values))
    assert axis.places == pytest.approx(places)
    assert axis.labels == labels
    assert axis.title == "noise [m]"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("# How many CAVs there are.\n", "", "must begin with a sentence that says what is varied; write it after #"),
        ("name: CAVs\n", "", "mine.yaml: name is missing; an axis has the keys name, unit, levels"),
        ("name: CAVs", 'name: ""', "name must be a text, got ''"),
        ('unit: ""', "unit: 3", "unit must be a text, got 3"),
        (
            'unit: ""',
            'unit: ""\nunits: 1',
            r"mine.yaml: unknown key units; did you mean \.?unit\? keys of an axis: levels, name, unit",
        ),
        ("    set: [scenario.cavs=6]\n", "", "levels.1: set is missing; a level has the keys value, set"),
        ("  - value: 6\n    set: [scenario.cavs=6]\n", "", "levels must be a list of two or more, the mildest first"),
        ("  - value: 6\n    set: [scenario.cavs=6]\n", "  - 6\n", "levels.1 must hold value and set, got 6; write"),
        ("value: 6", "value: [6]", "levels.1.value must be a number or a name, got"),
        ("value: 6", "value: true", "levels.1.value must be a number or a name, got True"),
        ("value: 6", "value: .nan", "levels.1.value must be a number or a name, got nan"),
        ("value: 6", "value: six", "levels have numbers and names as values; give all of them one kind"),
        ("value: 6", "value: 2", "values of levels must rise, or fall, from level to level, got 2, 2; order them"),
        ("[scenario.cavs=6]", "scenario.cavs=6", "levels.1.set must be a list of key=value, got 'scenario.cavs=6'"),
        ("[scenario.cavs=6]", "[scenario.cavs]", "levels.1.set: scenario.cavs stands alone; write key and value"),
        ("scenario.cavs=6", "scenario.cavs=2", "levels.1.set is the same as levels.0.set; give each level other"),
        ("[scenario.cavs=6]", "['scenario.cavs=6,8']", "levels.1.set: scenario.cavs takes one value at a level"),
        ("scenario.cavs=6", "method=fcfs", "levels.1.set: method is no axis, since curves or runs differ in it"),
        ("scenario.cavs=6", "cda.binding=true", "levels.1.set: cda.binding is no axis, since curves or runs differ"),
        ("scenario.cavs=6", "seed=7", "levels.1.set: seed is no axis"),
        (
            "scenario.cavs=6",
            "senario.cavs=6",
            "levels.1.set: unknown key senario; did you mean scenario",
        ),
        ("[scenario.cavs=6]", "['drivers.x=${oc.env:HOME}']", "reads an environment variable"),
        ("levels:", "levels: [", "cannot be read"),
        (GOOD, "# One.\n- 1\n", "must hold the keys name, unit, levels"),
        (GOOD, "# One.\n", "name is missing"),
    ],
)
def test_a_file_that_cannot_be_used_is_refused(old: str, new: str, said: str, tmp_path: Path) -> None:
    folder = own(tmp_path, GOOD.replace(old, new))
    with pytest.raises(ConfigError, match=said) as refused:
        stress_axis("mine", folder)
    assert "mine.yaml" in str(refused.value)
    assert "\n" not in str(refused.value)


def test_names_have_to_differ(tmp_path: Path) -> None:
    text = re.sub(r"value: \d", "value: some", GOOD)
    with pytest.raises(ConfigError, match="levels have the same value twice; give each level a name of its own"):
        stress_axis("mine", own(tmp_path, text))


@pytest.mark.parametrize("name", ["cavs", "all"])
def test_a_file_does_not_take_the_name_of_another_axis(name: str, tmp_path: Path) -> None:
    own(tmp_path, GOOD)
    (tmp_path / "stress" / "mine.yaml").rename(tmp_path / "stress" / f"{name}.yaml")
    with pytest.raises(ConfigError, match="another name"):
        stress_axis("humans", tmp_path)
