"""Tables of scenes and what comes out of them, written so that a person can read and check them.

A table is a Markdown file. Each section describes one scene, in which ``?`` stands for the value that its rows vary::

    ## CAV1 comes to a crossing at which CAV2 goes first

    intersection: CAV1 south-north ? 6.0; CAV2 west-east 97.0 6.0; CAV2 before CAV1

    |    ? | what comes out |
    |------|----------------|
    | 90.3 | -              |
    | 90.4 | FASTER         |

The scene is as ``CAV1`` sees it, or as ``CAV2`` does if it says ``for CAV2``; the order is advice, unless it says
``binding``.

A vehicle is its name (which tells who drives), its route, the place on it [m] and its speed [m/s], and then, where they
matter, ``target=`` [m/s], ``pedal=`` (acceleration) [m/s2], ``offset=`` from the centre line [m] and ``standing=`` [s].
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from worlds import Car, Junction, Thoughts, car, order_of, standing

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.situation import Situation
from codriving.datatypes.world import Action
from codriving.reasoning.decision.rules import decide_one
from codriving.reasoning.ordering.problem import Problem
from codriving.reasoning.safety.safety_input import SafetyInput

NAMED = re.compile(r"crossing|converging|weaving|[CH][AD]V\d|in the way|lane ends|other side|\d+\.?\d* m(?:/s2)?\b")
"""What of a reason stands in a table."""

REASONS = re.compile(
    r"earlier|turns|no longer stop|drives ahead|wait less|gives way|no intent|is through|through before|may come|guess"
    r"|\d+\.\d s(?: against \d+\.\d s)?"
)
"""What of the reasons of an order stands in a table."""


@dataclass(frozen=True)
class Section:
    """One scene of a table, and its rows: the value that is varied, and what comes out."""

    title: str
    scene: str
    rows: tuple[tuple[str, str], ...]

    @property
    def road(self) -> str:
        """Name of the scenario."""
        return self.scene.split(":")[0].strip()


def sections(file: Path) -> list[Section]:
    """Read a table."""
    found = []
    for part in re.split(r"^## ", file.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        title, *lines = part.splitlines()
        (scene,) = [line for line in lines if re.match(r"(intersection|highway|merge|roundabout):", line)]
        cells = [[c.strip() for c in line.strip("|").split("|")] for line in lines if line.startswith("| ")]
        found.append(Section(title, scene, tuple((value, " | ".join(rest)) for value, *rest in cells[1:])))
    return found


@dataclass(frozen=True)
class Setting:
    """A scene that has been read: the vehicles, the order, and who has been standing for how long."""

    cars: tuple[Car, ...]
    order: PassingOrder | None
    stood: dict[str, float]
    ego: str

    def think(self, junction: Junction) -> Thoughts:
        """States, intents and conflicts."""
        return junction.thoughts(*self.cars)

    def safety_input(self, junction: Junction) -> SafetyInput:
        """What one CAV sees; the order is the coordinator's if none is given."""
        seen = self.think(junction).safety_input(self.ego, self.order)
        for name, time in self.stood.items():
            seen = standing(seen, name, time)
        return seen


def setting(scene: str, value: str) -> Setting:
    """Read a scene, with a value in place of ``?``."""
    cars, pairs, stood, binding, ego = [], [], dict[str, float](), False, "CAV1"
    for part in scene.replace("?", value).split(":", 1)[1].split(";"):
        words = part.split()
        if words == ["binding"]:
            binding = True
        elif words[0] == "for":
            ego = words[1]
        elif words[1] == "before":
            pairs.append(f"{words[0]} {words[2]}")
        else:
            more = {k: float(v) for k, v in (word.split("=") for word in words[4:])}
            if "standing" in more:
                stood[words[0]] = more.pop("standing")
            cars.append(car(words[0], words[1], float(words[2]), float(words[3]), **more))
    return Setting(tuple(cars), order_of(*pairs, binding=binding) if pairs else None, stood, ego)


def removals(given: SafetyInput, *layers: Callable[[SafetyInput], dict[Action, list[str]]]) -> str:
    """Write down the actions that some layers remove, each with what the reasons name: relations, vehicles, numbers."""
    found: dict[Action, list[str]] = {}
    for layer in layers:
        for action, reasons in layer(given).items():
            found.setdefault(action, []).extend(" ".join(NAMED.findall(reason)) for reason in reasons)
    texts = (f"{a}: {', '.join(dict.fromkeys(found[a]))}" for a in given.actions if a in found)
    return "; ".join(texts) or "-"


def orders(order: PassingOrder) -> str:
    """Write down who goes first, with what the reasons name."""
    texts = (f"{p.first} before {p.second}: {' '.join(REASONS.findall(p.reason))}" for p in order.precedences)
    return "; ".join(texts) or "-"


def posed(problem: Problem) -> str:
    """Write down an ordering problem: times [s], distances [m], what must lie between two vehicles [s]."""
    instance = problem.instance
    texts = []
    for e in instance.vehicles.values():
        marks = [" committed"] * e.committed + [" turning"] * e.turning + [f" behind {e.leader}"] * bool(e.leader)
        shut = "".join(f" not {begin:.2f} to {end:.2f}" for begin, end in e.windows)
        numbers = f"in {e.eta:.2f} s, {e.distance:.1f} m, across {e.crossing:.2f} s, to go {e.remaining:.1f} m"
        texts.append(f"{e.id} {numbers}{''.join(marks)}{shut}")
    texts += [f"{one} then {other} {apart:.2f} s" for (one, other), apart in sorted(instance.separation.items())]
    texts += [f"{one} has to go before {other}" for one, other in sorted(instance.before)]
    return "; ".join(texts) or "-"


def decided(situation: Situation) -> str:
    """Write down how far each action gets the CAV within 10 s [m], which ones stay, and the decision."""
    texts = []
    for a in situation.assessments:
        gains = "does not keep the order" if a.progress is None else f"{a.progress:.1f} m"
        arrivals = "".join(f" from {time:.2f} s" for time in a.arrivals)
        mark = "" if a.safe and not a.reasons else " forced" if a.safe else " unsafe"
        texts.append(f"{a.action} {gains}{arrivals}{mark}")
    return f"{decide_one(situation).action}; of {', '.join(texts)}"
