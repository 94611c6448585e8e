"""Config nodes become objects, and every mistake in them becomes one clear line."""

from typing import Any

import pytest

from codriving.config.build import asks_for, build, validate
from codriving.config.compose import compose
from codriving.datatypes.parts import Model
from codriving.errors import ConfigError, ScenarioError


def car(package: str, **changes: object) -> dict[str, Any]:
    node: dict[str, Any] = {
        "_target_": f"{package}.Car",
        "seats": 4,
        "length": 5,
        "electric": True,
        "gears": [1, 2, 3],
        "size": [2, 1.5],
        "colour": "red",
        "drive": "rear",
        "wheel": {"_target_": f"{package}.Wheel", "radius": 0.3},
        "name": None,
        "extras": ["radio"],
    }
    return {**node, **changes}


def message(package: str, **changes: object) -> str:
    with pytest.raises(ConfigError) as err:
        build(car(package, **changes), object, "car", [package])
    assert "\n" not in str(err.value)
    return str(err.value)


def test_builds_nested_nodes_and_converts_without_guessing(garage: str) -> None:
    made = build(car(garage), object, "car", [garage])
    assert (made.seats, made.gears, made.size, made.extras) == (4, (1, 2, 3), (2.0, 1.5), ["radio"])
    assert isinstance(made.length, float)
    assert made.colour.name == "RED"
    assert made.wheel.radius == 0.3
    assert made.name is None


@pytest.mark.parametrize(
    ("key", "value", "expected"),
    [
        ("seats", 4.0, "car.seats must be a whole number, got 4.0"),
        ("seats", "4", "car.seats must be a whole number, got '4'"),
        ("seats", True, "car.seats must be a whole number, got True"),
        ("seats", None, "car.seats must be a whole number, got None"),
        ("length", True, "car.length must be a number, got True"),
        ("length", float("nan"), "car.length must be a finite number, got nan"),
        ("length", float("inf"), "car.length must be a finite number, got inf"),
        ("electric", 1, "car.electric must be true or false, got 1"),
        ("electric", "yes", "car.electric must be true or false, got 'yes'"),
        ("gears", 3, "car.gears must be a list, got 3"),
        ("gears", [1, "x"], "car.gears must be a list, each a whole number, got [1, 'x']"),
        ("size", [1, 2, 3], "car.size must be a list of 2 values, got [1, 2, 3]"),
        ("colour", "green", "car.colour must be one of red, blue, got 'green'"),
        ("drive", "side", "car.drive must be one of front, rear, got 'side'"),
        ("name", 5, "car.name must be a text or null, got 5"),
        ("extras", "radio", "car.extras must be a list, got 'radio'"),
    ],
)
def test_wrong_types_name_key_rule_and_value(garage: str, key: str, value: object, expected: str) -> None:
    assert message(garage, **{key: value}) == expected


def test_unknown_key_names_the_closest_and_hides_the_value(garage: str) -> None:
    text = message(garage, lenght="secret")
    assert text.startswith("unknown key car.lenght; did you mean car.length? keys of car: colour, drive, ")
    assert "secret" not in text


def test_missing_key(garage: str) -> None:
    node = car(garage)
    del node["seats"]
    with pytest.raises(ConfigError, match=r"^car\.seats is missing; Car needs it$"):
        build(node, object, "car", [garage])


def test_constructor_errors_get_the_key(garage: str) -> None:
    assert message(garage, seats=99) == "car.seats must be 1 to 9, got 99"
    wheel = {"_target_": f"{garage}.Wheel", "radius": -1}
    assert message(garage, wheel=wheel) == "car.wheel.radius must be above 0 m, got -1"
    assert message(garage, colour="blue", electric=False) == "car.electric=false needs car.colour=red"


def test_constructor_errors_keep_their_class(garage: str) -> None:
    with pytest.raises(ScenarioError, match=r"^car: the car does not fit"):
        build(car(garage, length=21), object, "car", [garage])


def test_annotations_that_cannot_be_resolved_are_left_to_the_constructor(garage: str) -> None:
    node = {"_target_": f"{garage}.Later", "gap": 1, "other": 2}
    assert build(node, object, plugins=[garage]).other == 2
    with pytest.raises(ConfigError, match="gap must be a whole number"):
        build({**node, "gap": "x"}, object, plugins=[garage])


@pytest.mark.parametrize(
    "target",
    ["os.system", "subprocess.Popen", "codriving_evil.Thing", "codrivingx", "", 5],
)
def test_nothing_outside_the_allowed_packages_is_imported(target: object) -> None:
    with pytest.raises(ConfigError, match="_target_"):
        build({"_target_": target}, object, "scenario")


def test_only_classes_of_the_package_itself_can_be_named(garage: str) -> None:
    for name in ("function", "system", "StrEnum", "nothing"):
        with pytest.raises(ConfigError, match=f"has no class {name}"):
            build({"_target_": f"{garage}.{name}"}, object, "car", [garage])
    with pytest.raises(ConfigError, match="list other packages under plugins"):
        build({"_target_": f"{garage}.Wheel", "radius": 1.0}, object)


def test_missing_module_is_told_from_a_bug_inside_one(garage: str, tmp_path: Any) -> None:
    with pytest.raises(ConfigError, match="there is no module"):
        build({"_target_": f"{garage}.cellar.Box"}, object, "car", [garage])
    (tmp_path / "site" / garage / "attic.py").write_text("import no_such_module_anywhere\n")
    with pytest.raises(ModuleNotFoundError):
        build({"_target_": f"{garage}.attic.Box"}, object, "car", [garage])


def test_a_node_needs_a_target() -> None:
    with pytest.raises(ConfigError, match="scenario must hold a _target_"):
        build({"cavs": 3}, object, "scenario")


def test_a_class_is_refused_where_its_place_expects_another_before_it_is_called(garage: str) -> None:
    nested = {"_target_": f"{garage}.Later", "gap": 1, "other": 2}
    assert message(garage, wheel=nested) == (
        f"car.wheel must be Wheel, but {garage}.Later is none; name another class, or let it inherit from "
        f"{garage}.Wheel"
    )
    assert "car.seats must be a plain value" in message(garage, seats=nested)
    with pytest.raises(ConfigError, match=r"^llm must be Model, but codriving\.metrics\.\S+ is none"):
        build({"_target_": "codriving.metrics.standard.StandardMetrics", "free_speed": "x"}, Model, "llm")


def test_what_is_handed_in_is_not_set_in_a_yaml(garage: str) -> None:
    wheel = build({"_target_": f"{garage}.Wheel", "radius": 0.5}, object, plugins=[garage])
    given = {type(wheel): wheel}
    node = car(garage)
    with pytest.raises(ConfigError, match=r"car\.wheel is not set here .* delete the line `wheel:` from its YAML"):
        build(node, object, "car", [garage], given)
    del node["wheel"]
    assert build(node, object, "car", [garage], given).wheel is wheel
    with pytest.raises(ConfigError, match="car cannot do without wheel, and none is chosen; set wheel=<name>"):
        build(node, object, "car", [garage], {type(wheel): None})
    assert asks_for([{"inner": node}], type(wheel), [garage])
    assert not asks_for(node, Model, [garage])


def test_a_limit_is_named_as_it_is_set() -> None:
    with pytest.raises(ConfigError, match=r"^limits\.lateral must be 2 to 12 m/s2, got 1$"):
        validate(compose(["limits=road", "limits.lateral=1"]))
