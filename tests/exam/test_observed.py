"""Who is observed drives as codriving does, and keeps to what is forced."""

from codriving.config.compose import compose
from codriving.exam.building import _objects, worlds
from codriving.exam.observed import notebook_of
from codriving.experiment.objects import make_objects


def test_it_drives_as_codriving_and_an_order_can_be_forced() -> None:
    environment, (observed, planned) = _objects(worlds()["standoff"])
    plain = make_objects(compose(["suite=standoff"])).method
    world, notebook = environment.reset(20_000), notebook_of(observed)
    notebook.closed = False
    for method in (observed, planned, plain):
        method.reset(environment.road_map, environment.driving_model, 1)
    for _ in range(4):
        notebook.empty()
        actions = observed.act(world).actions
        assert actions == plain.act(world).actions
        world = environment.step(actions)
    posed = notebook.posed[0]
    c = posed.conflicts[0]
    first = posed.order.first_of(c.ego, c.other)
    second = c.other if first == c.ego else c.ego
    for method in (observed, planned):
        forced = notebook_of(method).forced
        forced[second, str(first)] = "so it is asked"
        pairs = [p for cav in method.act(world).as_dict()["cavs"] for p in cav["order"]["precedences"]]
        assert {p["first"] for p in pairs if {p["first"], p["second"]} == {c.ego, c.other}} == {second}
        forced.clear()
