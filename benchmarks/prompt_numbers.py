"""How often the number that is printed per action names the rules' action: what a prompt hands over of their answer."""

import json
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from benchmarks.options import options
from codriving.briefing.judging import nothing_to_judge
from codriving.config.build import build
from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.datatypes import Action, Decision, Situation
from codriving.environment.environment import Environment
from codriving.llm import Ledger, decision_view, load_prompts
from codriving.llm.language_model import Offline
from codriving.llm.prompts.render import SETS
from codriving.methods.codriving import CoDriving
from codriving.reasoning import Decider, RuleDecider, is_plain
from codriving.reasoning.decision.control_deciders import FastestDecider
from codriving.reasoning.sharing.sharing import CdaLevel

FIRST_SEED, EPISODES = 10_000, 10
FULL = CdaLevel(True, True, True, True, False, "own_view")

_LINE = re.compile(r"^- ((?:SLOWER|IDLE|HOLD|FASTER|LANE_LEFT|LANE_RIGHT)(?:, [A-Z_]+)*)(?!.* removed:)(.*)$", re.M)


class Recording(Decider):
    """Drives by the rules, and keeps what each CAV was told."""

    def __init__(self) -> None:
        self.seen: list[Situation] = []

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        self.seen += situations
        return RuleDecider().decide(situations)


def situations(scenario: str, seeds: Iterable[int]) -> list[Situation]:
    """Drive episodes by the rules, and return the situations in which there are two actions at least."""
    environment = build(compose([f"scenario={scenario}"])["environment"], Environment)
    method, recording = CoDriving(FULL, Offline(), None, 1.5), Recording()
    for seed in seeds:
        world = environment.reset(seed)
        method.reset(environment.road_map, environment.driving_model, seed)
        method.pipeline.decider, method.pipeline.ledger = recording, Ledger()
        while environment.outcome is None:
            world = environment.step(method.act(world).actions)
    return [s for s in recording.seen if len(s.allowed) > 1]


def asked(situation: Situation, prompts: str) -> bool:
    """Whether a model is asked in a situation."""
    return not is_plain(situation, True) and not (prompts == "informed" and nothing_to_judge(situation))


def numbers(text: str) -> dict[str, dict[Action, float]]:
    """Read off a prompt what number each action has, by what is said before it."""
    found: dict[str, dict[Action, float]] = defaultdict(dict)
    for names, rest in _LINE.findall(text):
        for words, value, unit in _named(rest):
            for name in names.split(", "):
                found[f"{words} [{unit}]"][Action(name)] = float(value)
    return found


def _named(rest: str) -> Iterator[tuple[str, str, str]]:
    """Give the words before each number of a line, without the ids in them but of whose zone it is."""
    for part in re.split(r"[;:]|, (?=with )", rest):
        for words, value, unit in re.findall(r"^(.*?)\s*(-?\d+(?:\.\d+)?) (m/s2|m/s|s|m)(?![\w/])", part.strip(" ,")):
            whose = re.match(r"(?:at the zone )?with (.+) in$", words)
            if whose:
                yield from ((f"zone of {name}", value, unit) for name in whose.group(1).split(" and "))
            elif unit == "m/s2":
                yield "braking behind", value, unit
            elif words.startswith("delays"):
                yield "delay", value, unit
            else:
                yield words.strip() or "arrives", value, unit


@dataclass
class Agreement:
    """How often one number is printed, and how often its best and the fastest action are what the rules take."""

    printed: int = 0
    agrees: tuple[int, int] = (0, 0)  # Highest and lowest
    first: int = 0

    def row(self) -> dict[str, float]:
        """Shares of the decisions in which it is printed."""
        return {
            "printed": self.printed,
            "agrees": round(max(self.agrees) / self.printed, 3),
            "first": round(self.first / self.printed, 3),
        }


def measure(seen: Sequence[Situation], prompts: str) -> dict[str, dict[str, float]]:
    """Compare each number that a set of prompts prints with the rules.

    Args:
        seen: Situations.
        prompts: Name of the set.

    Returns:
        One row a number; that of a zone is one a vehicle, all under one name.
    """
    found: dict[str, Agreement] = defaultdict(Agreement)
    for situation in (s for s in seen if asked(s, prompts)):
        text = load_prompts(prompts).messages("decide", decision_view(situation))[1].content
        (rule,), (first,) = RuleDecider().decide([situation]), FastestDecider().decide([situation])
        rank = {a: situation.scene.speed_rank(a) or -1.0 for a in situation.allowed}
        for name, values in numbers(text).items():
            known = {a: value for a, value in values.items() if a in rank}
            if any(word in name for word in ("braking", "delay")):
                known = {a: known.get(a, 0.0) for a in rank}
            if len(known) < 2:
                continue
            # Of several that are equal the fastest is taken.
            highest, lowest = (max(known, key=lambda a: (sign * known[a], rank[a])) for sign in (1, -1))
            of = found["zone [s]" if name.startswith("zone of") else name]
            of.printed, of.first = of.printed + 1, of.first + (first.action is rule.action)
            of.agrees = of.agrees[0] + (highest is rule.action), of.agrees[1] + (lowest is rule.action)
    return {name: agreement.row() for name, agreement in sorted(found.items())}


def main(arguments: list[str]) -> None:
    """Measure and print.

    Args:
        arguments: ``--json`` prints JSON instead of a table.
    """
    wanted = options(arguments, EPISODES)
    seeds = range(FIRST_SEED, FIRST_SEED + wanted.episodes)
    seen = {name: situations(name, seeds) for name in choices("scenario")}
    together = [s for each in seen.values() for s in each]
    found = {
        prompts: {**{name: measure(each, prompts) for name, each in seen.items()}, "all": measure(together, prompts)}
        for prompts in SETS
    }
    shares = {
        prompts: {name: [sum(asked(s, prompts) for s in each), len(each)] for name, each in seen.items()}
        for prompts in SETS
    }
    if wanted.json:
        print(json.dumps({"prompt_numbers": found, "asked": shares}))
        return
    print("prompt_numbers: how often the best of a number, and the fastest action, are what the rules take")
    for prompts, scenarios in found.items():
        print(f"  {prompts}: asked {shares[prompts]}")
        for scenario, rows in scenarios.items():
            for name, row in rows.items():
                print(f"    {scenario:14}{name:28}{row['printed']:7}{row['agrees']:8.1%}{row['first']:8.1%}")
