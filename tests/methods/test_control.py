"""Controls are codriving but for one part, and each table says that they are controls."""

import pytest
from worlds import Junction, car

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.parts import CaseMemory, Model, RuleModel
from codriving.errors import UserError
from codriving.methods.codriving import CoDriving
from codriving.methods.control import Control


def built(*overrides: str) -> CoDriving:
    """Return a method as it is configured."""
    node = compose(overrides)["method"]
    return build(node, CoDriving, "method", given={Model: RuleModel(), CaseMemory: None})


ROUTES = ("south-north", "west-east", "north-south", "east-west")

NAMES = ["fastest", "random_action", "random_order", "oracle"]


@pytest.mark.parametrize("name", NAMES)
def test_a_control_says_in_each_table_that_it_is_one(name: str, junction: Junction) -> None:
    control = built(f"method={name}")
    assert isinstance(control, Control)
    assert (control.name, control.variant, control.reasoner) == (name, "control", "rules")
    assert built(f"method={name}", "cda.safety_check=false").variant == "control/no_safety_check"
    assert control.remark(junction.road_map.road, {}).startswith(f"{name}: a control and no method: codriving ")


@pytest.mark.parametrize("name", ["fastest", "random_action"])
def test_a_control_knows_what_codriving_knows(name: str, junction: Junction) -> None:
    world = junction.world(
        car("CAV1", "south-north", 60.0, 6.0, 9.0), car("CAV2", "west-east", 40.0, 8.0), car("HDV1", "east-west", 20, 7)
    )
    lines = []
    for method in (built(f"method={name}"), built()):
        method.reset(junction.road_map, junction.model, 3)
        lines.append(method.act(world).as_dict()["cavs"])
    for mine, theirs in zip(*lines, strict=True):
        differs = {key for key in mine if mine[key] != theirs[key]}
        assert differs <= {"action", "reason"}
        assert mine["action"] in mine["allowed"]


def test_random_order_is_codriving_with_the_order_of_that_name(junction: Junction) -> None:
    world = junction.world(*(car(f"CAV{k}", route, 60.0, 8.0) for k, route in enumerate(ROUTES)))
    found = []
    for seed in range(6):
        both = [built("method=random_order"), built("order=random")]
        for method in both:
            method.reset(junction.road_map, junction.model, seed)
        mine, theirs = (method.act(world).as_dict() for method in both)
        assert mine == theirs
        found.append(tuple(mine["cavs"][0]["order"]["sequence"]))
    assert len(set(found)) >= 4


def test_a_random_order_is_common_without_negotiation_too() -> None:
    assert built("method=random_order", "cda.negotiation=false").variant == "control"
    assert built("method=random_order", "cda=status_sharing").cda.negotiation


@pytest.mark.parametrize("name", ["fastest", "random_action", "oracle"])
def test_other_controls_order_as_codriving_does(name: str) -> None:
    assert built(f"method={name}", "order=fcfs").variant == "control/order=fcfs"
    with pytest.raises(UserError, match="no place for order="):
        built(f"method={name}", "order=fcfs", "cda=status_sharing")


@pytest.mark.parametrize("name", NAMES)
def test_a_control_orders_by_zone_where_codriving_does(name: str) -> None:
    assert built(f"method={name}").by_zone
    assert not built(f"method={name}", "method.by_zone=false").by_zone
    assert not built(f"method={name}", "cda=prescriptive").by_zone
