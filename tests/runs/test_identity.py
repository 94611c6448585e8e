"""What tells a cell: names, values and the content of files; not the place of a class, not how much is driven."""

from dataclasses import replace
from typing import Any

import pytest
from manifests import cell

from codriving.config.compose import compose, compose_named
from codriving.runs.identity import (
    BEHAVIOUR,
    NamedFile,
    changed_files,
    driving_values,
    fingerprint,
    same_cell,
    settings_of,
    snapshot_of,
)

NAMES = ("intersection", "codriving", "full", "rules")
DECIDE = NamedFile("template decide.user.md.j2", "mine/decide.user.md.j2", "aa")
MEMORY = NamedFile("memory", "a.sqlite", "bb")


def told(*overrides: str, names: tuple[str, ...] = NAMES, files: tuple[NamedFile, ...] = ()) -> str:
    resolved, choices = compose_named(overrides)
    return fingerprint(names, choices, resolved, files)


def test_the_behaviour_number_is_written_down() -> None:
    assert BEHAVIOUR == 5


@pytest.mark.parametrize(
    "override", ["episodes=3", "workers=2", "output=elsewhere", "run=again", "launcher=serial", "plugins=[t_junction]"]
)
def test_how_much_is_driven_where_and_how_fast_tells_nothing(override: str) -> None:
    assert told(override) == told()


@pytest.mark.parametrize(
    "override", ["seed=1", "scenario.cavs=5", "cda.negotiation=false", "method=fcfs", "llm=ollama", "experiment=x"]
)
def test_names_and_values_tell(override: str) -> None:
    assert told(override) != told()


TODAY = ("limits=road", "drivers=attentive", "environment.steady=true")


def test_a_suite_is_told_by_its_values_alone() -> None:
    assert told("suite=paper") == told("limits=none", "drivers=simulator", "environment.steady=false")
    assert told("suite=default") == told() == told("suite=paper", *TODAY)
    assert told("suite=paper") != told()


def test_a_config_that_does_not_know_steady_driving_is_one_without_it() -> None:
    resolved = compose(["environment.steady=false"])
    before = {**resolved, "environment": {k: v for k, v in resolved["environment"].items() if k != "steady"}}
    assert settings_of(before) == settings_of(resolved)
    assert told("environment.steady=true") != told("environment.steady=false")


def test_a_config_that_does_not_know_limits_is_one_without_them() -> None:
    resolved = compose(["limits=none"])
    before = {key: value for key, value in resolved.items() if key != "limits"}
    before["environment"] = {key: value for key, value in before["environment"].items() if key != "limits"}
    assert fingerprint(NAMES, {}, resolved, ()) == fingerprint(NAMES, {}, before, ())
    assert driving_values(resolved) == driving_values(before)
    assert settings_of(resolved) == settings_of(before)
    assert settings_of(compose(["limits=road"])).items() >= {"limits.braking": "8.0", "limits.lateral": "4.0"}.items()
    assert told("limits=road") != told("limits=none") != told("limits=road", "limits.braking=7")


def test_a_config_that_does_not_know_flows_is_one_of_episodes() -> None:
    resolved = compose([])
    before = {key: value for key, value in resolved.items() if key != "flow"}
    before["environment"] = {key: value for key, value in before["environment"].items() if key != "flow"}
    assert fingerprint(NAMES, {}, resolved, ()) == fingerprint(NAMES, {}, before, ())
    assert settings_of(resolved) == settings_of(before)
    assert settings_of(compose(["flow=steady"])).items() >= {"flow.arrivals": "300.0", "flow.window": "120.0"}.items()
    assert told("flow=steady") != told() != told("flow=steady", "flow.arrivals=200") != told("flow=steady")


def test_a_config_that_does_not_know_orders_is_one_whose_order_is_negotiated() -> None:
    resolved = compose([])
    before = {key: value for key, value in resolved.items() if key != "order"}
    before["method"] = {key: value for key, value in before["method"].items() if key != "order"}
    assert fingerprint(NAMES, {}, resolved, ()) == fingerprint(NAMES, {}, before, ())
    assert settings_of(before) == settings_of(resolved)
    assert settings_of(compose(["order=fcfs"])).items() >= {"order.mode": '"conflict"'}.items()
    assert told() == told("order=negotiated") != told("order=fcfs") != told("order=fcfs", "order.control_radius=50")


def test_a_config_that_does_not_know_how_orders_hold_is_one_by_zone() -> None:
    resolved = compose(["method=codriving"])
    before = {**resolved, "method": {k: v for k, v in resolved["method"].items() if k != "by_zone"}}
    before["executor"] = {k: v for k, v in resolved["executor"].items() if k != "by_zone"}
    assert settings_of(before) == settings_of(resolved)
    assert len({told(), told("method.by_zone=false"), told("executor.by_zone=false")}) == 3


def test_an_order_or_a_filter_without_settings_is_told_by_its_name() -> None:
    plain, ordered = compose([]), compose(["order=random"])
    assert fingerprint(NAMES, {"order": "negotiated"}, plain, ()) == fingerprint(NAMES, {}, plain, ())
    assert fingerprint(NAMES, {"order": "random"}, ordered, ()) != fingerprint(NAMES, {"order": "mine"}, ordered, ())
    filtered = {**plain, "filter": {"_target_": "mine.Filter"}}
    assert fingerprint(NAMES, {"filter": "mine"}, filtered, ()) != fingerprint(NAMES, {"filter": "yours"}, filtered, ())


def test_a_config_that_does_not_know_how_human_drivers_are_minded_is_one_that_plans() -> None:
    resolved = compose(["method=fcfs"])
    executor = {k: v for k, v in resolved["executor"].items() if k not in ("humans", "human_margin", "by_zone")}
    before = {**resolved, "executor": executor, "method": {**resolved["method"], "executor": executor}}
    assert fingerprint(NAMES, {}, resolved, ()) == fingerprint(NAMES, {}, before, ())
    assert settings_of(resolved) == settings_of(before)
    changes = ("humans=checked", "human_margin=1.4")
    assert len({told("method=fcfs"), *(told("method=fcfs", f"executor.{change}") for change in changes)}) == 3


def test_a_config_that_does_not_know_the_group_of_drivers_is_one_with_those_of_the_simulator() -> None:
    resolved = compose(["drivers=simulator"])
    before = {key: value for key, value in resolved.items() if key != "drivers"}
    assert before["environment"]["drivers"]["jam_distance"] == 7.0
    assert fingerprint(NAMES, {}, resolved, ()) == fingerprint(NAMES, {}, before, ())
    assert settings_of(resolved) == settings_of(before)
    assert settings_of(resolved)["environment.drivers.headway"] == "1.5"
    assert told("drivers=mixed") != told("drivers=simulator") != told("drivers=simulator", "drivers.headway=1.2")
    assert told("drivers=mixed") != told("drivers=rough")


@pytest.mark.parametrize("name", ["intersection", "roundabout"])
def test_a_config_that_does_not_know_patterns_and_blocked_exits_is_one_without_them(name: str) -> None:
    resolved = compose([f"scenario={name}"])
    later = {"pattern": "random", "row_gap": 14.0, "turns": ["left", "straight", "right"]}
    later |= {"blocked_exit": 0.0, "blocked_room": 7.0}
    later |= {"blind": None} if name == "intersection" else {}
    assert {key: resolved["scenario"][key] for key in later} == later
    scenario = {key: value for key, value in resolved["scenario"].items() if key not in later}
    before = {**resolved, "scenario": scenario, "environment": {**resolved["environment"], "scenario": scenario}}
    assert fingerprint(NAMES, {}, resolved, ()) == fingerprint(NAMES, {}, before, ())
    assert settings_of(resolved) == settings_of(before)
    changes = ("pattern=standoff", "row_gap=15", "turns=[left]", "blocked_exit=20", "blocked_room=8")
    changes += ("blind=8",) if name == "intersection" else ()
    assert len({told(f"scenario={name}", f"scenario.{change}") for change in changes}) == len(changes)
    assert settings_of(compose([f"scenario={name}", "scenario.pattern=standoff"]))["scenario.pattern"] == '"standoff"'


def test_labels_and_files_tell() -> None:
    assert told(names=("merge", *NAMES[1:])) != told()
    assert told(files=(DECIDE,)) != told()
    assert told(files=(DECIDE,)) != told(files=(replace(DECIDE, sha256="cc"),))
    assert told(files=(DECIDE,)) == told(files=(replace(DECIDE, path="moved/decide.user.md.j2"),))


def test_two_yamls_of_the_same_values_are_two_methods() -> None:
    resolved = compose([])
    assert fingerprint(NAMES, {"method": "a"}, resolved, ()) != fingerprint(NAMES, {"method": "b"}, resolved, ())
    assert fingerprint(NAMES, {"cda": "a"}, resolved, ()) == fingerprint(NAMES, {"cda": "b"}, resolved, ())


def test_the_order_of_keys_tells_nothing() -> None:
    resolved = compose([])
    assert fingerprint(NAMES, {}, dict(reversed(resolved.items())), ()) == fingerprint(NAMES, {}, resolved, ())


def moved(node: Any) -> Any:
    """A config all of whose classes stand elsewhere."""
    if isinstance(node, dict):
        return {key: "codriving.elsewhere.Class" if key == "_target_" else moved(value) for key, value in node.items()}
    return node


def test_a_class_that_moves_changes_nothing() -> None:
    resolved = compose(["method=dilu"])
    assert moved(resolved) != resolved
    assert fingerprint(NAMES, {}, moved(resolved), ()) == fingerprint(NAMES, {}, resolved, ())
    assert not any("_target_" in key or "codriving." in value for key, value in settings_of(resolved).items())


def test_what_a_node_refers_to_is_told_once() -> None:
    assert driving_values({"cda": {"a": 1}, "method": {"cda": {"a": 1}, "b": [{"cda": {"a": 2}}]}}) == {
        "cda": {"a": 1},
        "method": {"b": [{"cda": {"a": 2}}]},
    }


def test_how_a_model_is_asked_tells_nothing_and_which_one_does() -> None:
    model = ("llm=custom", "llm.api_base=http://127.0.0.1:1/v1")
    for setting in ("max_cost=2.0", "max_concurrency=2", "cache=replay", "cache_file=other", "api_key_env=MY_KEY"):
        assert told(*model, f"llm.{setting}") == told(*model)
    for setting in ("model=openai/other", "temperature=0.5", "max_tokens=5", "ask_plain=true", "api_base=null"):
        assert told(*model, f"llm.{setting}") != told(*model)


def test_a_memory_that_knows_no_controls_is_one_without() -> None:
    asked = ("memory=frozen", "memory.file=a", "memory.snapshot=bb")
    resolved = compose(asked)
    before = {**resolved, "memory": {k: v for k, v in resolved["memory"].items() if k != "control"}}
    assert driving_values(before) == driving_values(resolved)
    assert driving_values(before) != driving_values(compose([*asked, "memory.control=rule"]))


def test_a_memory_is_told_by_its_snapshot_wherever_its_file_lies() -> None:
    one, two = (compose(["memory=frozen", f"memory.file={name}", "memory.snapshot=bb"]) for name in ("a", "b"))
    assert driving_values(one) == driving_values(two)
    assert snapshot_of(one) == (NamedFile("memory", "a", "bb"),)
    assert snapshot_of(compose(["memory=frozen", "memory.file=a"])) == ()
    assert snapshot_of(compose([])) == ()


def test_a_changed_file_is_named() -> None:
    held = replace(cell("f1"), choices={"method": "codriving"}, files=(DECIDE, MEMORY))

    def changed(*files: NamedFile) -> list[str]:
        return list(changed_files(held, replace(held, fingerprint="f2", files=files)))

    assert changed(DECIDE, MEMORY) == []
    assert changed(replace(DECIDE, sha256="cc"), MEMORY) == [
        "mine/decide.user.md.j2 (template decide.user.md.j2) has changed"
    ]
    assert changed(MEMORY) == ["mine/decide.user.md.j2 (template decide.user.md.j2) was removed"]
    added = NamedFile("plug-in mine/new.py", "mine/new.py", "dd")
    assert changed(DECIDE, MEMORY, added) == ["mine/new.py (plug-in mine/new.py) was added"]
    assert changed(DECIDE, replace(MEMORY, sha256="cc")) == ["a.sqlite (memory) has changed"]
    assert changed(DECIDE, NamedFile("memory", "b.sqlite", "cc")) == [], "another memory, not a changed one"


def test_a_cell_of_release_0_1_is_told_by_labels_and_values() -> None:
    here = replace(cell("f1", a="1"), choices={"method": "codriving"}, files=(DECIDE, MEMORY))
    there = replace(cell("", a="1"), choices={}, files=(MEMORY,))
    assert same_cell(there, here)
    assert not same_cell(replace(there, method="fcfs"), here)
    assert not same_cell(replace(there, settings={"a": "2"}), here)
    assert not same_cell(replace(there, files=(replace(MEMORY, sha256="cc"),)), here)


def test_names_of_keys_and_patience_are_no_part_of_a_cell() -> None:
    memory = {"embedder": "litellm", "embedding_key_env": "ONE_KEY", "embedding_deadline": 30.0}
    other = {"embedder": "litellm", "embedding_key_env": None, "embedding_deadline": 5.0}
    llm = {"model": "m", "api_key_env": "ONE_KEY", "part": {"their_key_env": "A"}}
    other_llm = {"model": "m", "api_key_env": "TWO_KEY", "part": {"their_key_env": "B"}}
    assert driving_values({"memory": memory, "llm": llm}) == driving_values({"memory": other, "llm": other_llm})
    assert driving_values({"memory": {**memory, "embedder": "words"}}) != driving_values({"memory": memory})
