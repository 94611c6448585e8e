"""What rules read and what models are told, field by field: the table of ``docs/what-a-model-is-told.md``."""

import os
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import fields, is_dataclass, replace
from math import inf
from pathlib import Path
from typing import Any

import pytest
from asked import reasoned, sensible
from remembered import memory
from shown import WORLDS, WRITE
from source import REPOSITORY
from worlds import Junction, Thoughts, car

from codriving.datatypes.experience import Memory
from codriving.datatypes.judgement import Judgement
from codriving.datatypes.order import Approach, ApproachingVehicle, Conflict, Instance, PassingOrder, Precedence
from codriving.datatypes.outlook import ActionOutlook, ExpectedPassage, HumanOutlook, Outlook
from codriving.datatypes.situation import (
    ActionAssessment,
    LaneChange,
    LaneNeighbour,
    SceneDescription,
    Situation,
    TrackedVehicle,
)
from codriving.datatypes.world import Action, Intent, Kind, VehicleState
from codriving.llm.prompts.free_text import Names
from codriving.llm.prompts.render import SETS, load_prompts
from codriving.llm.prompts.variables import decision_view, negotiation_view
from codriving.reasoning.decision.rules import RuleDecider
from codriving.reasoning.ordering.coordinator import RuleCoordinator
from codriving.reasoning.ordering.problem import pose

PAGE = REPOSITORY / "docs" / "what-a-model-is-told.md"

DECISION = (
    Situation, SceneDescription, VehicleState, Intent, TrackedVehicle, LaneChange, LaneNeighbour, Conflict,
    PassingOrder, Precedence, ActionAssessment, Memory, Judgement, Outlook, ActionOutlook,
    ExpectedPassage, HumanOutlook,
)  # fmt: skip
ORDER = (Instance, ApproachingVehicle, Approach)

Field = tuple[str, str]


@contextmanager
def watched(kinds: tuple[type, ...], on_read: Callable[[type, str, Any], Any]) -> Iterator[None]:
    """Hand every field of some dataclasses that is read by its name to a function, which returns what is read."""
    names = {kind: frozenset(f.name for f in fields(kind)) for kind in kinds}
    with pytest.MonkeyPatch.context() as patch:
        for kind in kinds:

            def read(self: Any, name: str, kind: type = kind) -> Any:
                value = object.__getattribute__(self, name)
                # What copies or compares whole objects reads nothing in particular.
                plain = name not in names[kind] or sys._getframe(1).f_globals["__name__"] == "dataclasses"
                return value if plain or sys._getframe(1).f_code.co_name == "__eq__" else on_read(kind, name, value)

            patch.setattr(kind, "__getattribute__", read, raising=False)
        yield


def reads(kinds: tuple[type, ...], work: Callable[[], object]) -> set[Field]:
    """The fields that some work reads."""
    found: set[Field] = set()

    def note(kind: type, name: str, value: Any) -> Any:
        found.add((kind.__name__, name))
        return value

    with watched(kinds, note):
        work()
    return found


def other(value: Any) -> Any:
    """Another value of the same kind."""
    if isinstance(value, bool) or value is None:
        return not value
    if isinstance(value, int | float):
        return 7.25 if value in (inf, -inf) else value + 7.25
    if isinstance(value, str):
        members = list(type(value)) if hasattr(type(value), "__members__") else []
        return next((m for m in members if m != value), f"{value}x")
    if isinstance(value, tuple) and not any(map(is_dataclass, value)):
        return tuple(map(other, value))
    return None if is_dataclass(value) else value[1:] if isinstance(value, tuple | list) else type(value)()


def told(kinds: tuple[type, ...], texts: Callable[[], list[str]]) -> set[Field]:
    """The fields on which a text depends: if one of them alone reads otherwise the text does so, too."""
    plain, known = texts(), reads(kinds, texts)
    found = set()
    for wanted in known:

        def changed(kind: type, name: str, value: Any, wanted: Field = wanted) -> Any:
            return other(value) if (kind.__name__, name) == wanted else value

        with watched(kinds, changed):
            try:
                differs = texts() != plain
            except Exception:
                differs = True  # Nothing can be told any more
        if differs:
            found.add(wanted)
    return found


@pytest.fixture(scope="module")
def situations(junction: Junction, highway: Junction, merge: Junction) -> list[Situation]:
    """Situations in which every field has something to say."""
    human = car("HDV1", "east-south", 76, 8)
    first = reasoned(junction, sensible, ask_plain=True).method.act(junction.world(*WORLDS["intersection"]))
    found = [
        *first.situations[:1],
        *reasoned(junction, sensible).method.act(
            junction.world(car("CAV1", "south-north", 80, 8, 9), human, car("CAV2", "east-south", 90, 8))
        ).situations[:1],
        *reasoned(highway, sensible).method.act(highway.world(*WORLDS["highway"])).situations[:1],
        *reasoned(merge, sensible).method.act(merge.world(*WORLDS["merge"])).situations[2:3],
        *reasoned(junction, sensible, state_sharing=False, ask_plain=True)
        .method.act(junction.world(car("CAV1", "south-north", 80, 8, 9), human)).situations[:1],
    ]  # fmt: skip
    stands = reasoned(junction, sensible, ask_plain=True)
    both = car("CAV1", "south-north", 88, 0, 0), car("HDV1", "east-west", 88, 0)
    for k in range(4):
        standing = stands.method.act(junction.world(*both, time=k / 2, step=k)).situations[0]
    lanes = found[2]
    needs = LaneChange(lanes.scene.ego.lane, 50.0, Action.LANE_LEFT)
    hold = ActionAssessment(Action.HOLD, True, (), (), 40.0, 8.0)
    found += [
        standing,
        replace(lanes, scene=replace(lanes.scene, must_change=needs, covers=(("lane-0", 100.0),))),
        replace(found[0], assessments=(*found[0].assessments, hold)),
    ]
    judged = {"HDV1": Judgement(0.2, "goes", "it does not brake")}
    return [replace(s, memories=(memory(count=2),), judgements=judged) for s in found]


@pytest.fixture(scope="module")
def thoughts(junction: Junction) -> Thoughts:
    return junction.thoughts(
        car("CAV1", "south-north", 60, 8, 9), car("CAV2", "west-south", 62, 8, 9), car("CAV3", "east-south", 62, 8, 9),
        car("CAV4", "south-east", 40, 8, 9), car("HDV1", "north-south", 66, 8),
    )  # fmt: skip


def deciding(situations: list[Situation], prompts: str) -> list[str]:
    return [load_prompts(prompts).messages("decide", decision_view(s))[1].content for s in situations]


def negotiating(thoughts: Thoughts, prompts: str) -> list[str]:
    moment = thoughts.moment()
    problem = pose(moment)
    urgent = {(c.ego, c.other): c for cs in moment.conflicts.values() for c in cs if c.other in moment.scenes}
    pairs = [(f"{c.ego}_{c.other}", c) for (one, two), c in sorted(urgent.items()) if one < two]
    names = Names([*moment.scenes, "HDV1"])
    view = negotiation_view(moment.scenes, problem.instance, pairs, None, names, False, problem.passages)
    return [load_prompts(prompts).messages("negotiate", view)[1].content]


def rows() -> dict[Field, list[str]]:
    """The table of the page: marks of rules and sets, and why they differ, by class and field."""
    found = re.findall(r"^\| `(\w+)\.(\w+)` \|([^|]*)\|([^|]*)\|([^|]*)\|([^|]*)\|$", PAGE.read_text("utf-8"), re.M)
    return {(kind, name): [cell.strip() for cell in cells] for kind, name, *cells in found}


def test_page_says_what_rules_read_and_models_are_told(situations: list[Situation], thoughts: Thoughts) -> None:
    moment, kinds = thoughts.moment(), (*DECISION, *ORDER)
    problem = pose(moment)
    columns = [
        reads(DECISION, lambda: RuleDecider().decide(situations))
        | reads(ORDER, lambda: RuleCoordinator(False).settle(moment, problem, {})),
        *(
            told(DECISION, lambda name=name: deciding(situations, name))  # type: ignore[misc]
            | told(ORDER, lambda name=name: negotiating(thoughts, name))  # type: ignore[misc]
            for name in SETS
        ),
    ]
    known = rows()
    made = {
        (kind.__name__, f.name): ["yes" if (kind.__name__, f.name) in column else "" for column in columns]
        for kind in kinds
        for f in fields(kind)
    }
    if os.environ.get(WRITE):
        lines = [
            f"| `{k}.{n}` | {' | '.join([*marks, (known.get((k, n)) or [''] * 4)[3]])} |"
            for (k, n), marks in made.items()
        ]
        head, _, rest = PAGE.read_text("utf-8").partition("<!-- fields -->\n")
        PAGE.write_text(
            f"{head}<!-- fields -->\n" + "\n".join(lines) + "\n" + rest[rest.index("<!-- end -->") :], "utf-8"
        )
    page = {field: cells[:3] for field, cells in rows().items()}
    assert made == page, f"if that is meant: {WRITE}=1 pytest {Path(__file__).name}"
    unexplained = [field for field, cells in rows().items() if len(set(cells[:3])) > 1 and not cells[3]]
    assert not unexplained, "rules and models are to be told the same; where they are not the page says why"


def test_hidden_driver_is_watched(situations: list[Situation]) -> None:
    """What is found is found because of a difference in the text."""
    assert {n.kind for n in situations[-1].scene.neighbours} <= {None, Kind.CAV, Kind.HDV}
    assert ("VehicleState", "speed") in told((VehicleState,), lambda: deciding(situations, "informed"))
    assert ("VehicleState", "width") not in told((VehicleState,), lambda: deciding(situations, "informed"))
