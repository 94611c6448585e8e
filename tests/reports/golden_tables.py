"""All tables of a few made-up episodes, in which everything occurs that a table can show."""

import io
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

from codriving.config.locate import experiments_dir
from codriving.datatypes.record import Collision, Ending, EpisodeRecord, Outcome, Participant, Pet, Score, TravelScore
from codriving.datatypes.stress import StressAxis, StressLevel
from codriving.reports.built_memory import BuiltMemory, print_built
from codriving.reports.columns import table
from codriving.reports.comparison import (
    Condition,
    comparison_rows,
    comparison_table,
    print_comparison,
    print_pairs,
    with_corrected,
)
from codriving.reports.episodes import TimedEpisode, timing_columns
from codriving.reports.learning import LearningRow, learning_rows, learning_table, print_learning
from codriving.reports.load import load_rows, load_table, print_each_load, print_loads
from codriving.reports.models import Repetition, model_rows, model_table, print_models
from codriving.reports.paper import Paper, read_learning, read_paper
from codriving.reports.printed import PrintedTable, markdown_text, print_table
from codriving.reports.results import CellResults
from codriving.reports.stress import StressCurve, breaking_table, print_stress, stress_notes, stress_table
from codriving.reports.summary import run_tables
from codriving.runs.episode_folder import timing_of

ASKED = {"model_calls": 1200, "prompt_tokens": 400_000, "completion_tokens": 20_000, "cost_usd": 0.1, "re_asks": 190,
         "fallbacks": 10, "shortened": 10, "model_seconds": 6.5}  # fmt: skip


def record(
    seed: int,
    ending: Ending = Ending.SUCCESS,
    method: str = "codriving",
    variant: str = "full",
    reasoner: str = "rules",
    scenario: str = "intersection",
    faster: float = 0.0,
    counts: dict[str, Any] | None = None,
    memory: str = "",
    metric: str = "standard",
) -> EpisodeRecord:
    """One episode; pets and velocities go by the seed."""
    hit = Collision(3.25, "CAV0", "HDV0", "CAV-HDV") if ending is Ending.COLLISION else None
    outcome = Outcome(
        ending,
        12.0 + seed / 3,
        {"CAV0": 9.0} if ending is Ending.SUCCESS else {},
        hit,
        (Collision(4.0, "HDV1", "HDV0", "HDV-HDV"),) if seed % 5 == 4 else (),
        ("CAV1",) if ending is Ending.OFF_ROAD else (),
        "RuntimeError: x, y" if ending is Ending.ERROR else "",
    )
    pets = (Pet("CAV0", "CAV1", "crossing", 1.2 + seed / 2), Pet("HDV0", "CAV1", "merging", 3.75)) if seed != 3 else ()
    travels = (
        TravelScore("CAV0", 7.123 + seed / 7 + faster, 10.5 + seed, 1.25),
        TravelScore("CAV1", 6.0 + faster, 11.0, None if seed == 2 else -0.5),
    )
    return EpisodeRecord(
        scenario,
        method,
        variant,
        reasoner,
        seed,
        outcome,
        {} if ending is Ending.ERROR else {metric: Score(ending is Ending.SUCCESS, pets, travels)},
        (
            Participant("CAV0", "CAV", "a", None),
            Participant("CAV1", "CAV", "b", 9.0),
            Participant("HDV0", "HDV", "c", None),
        ),
        12 + seed,
        counts or {},
        memory,
    )


def episodes(failing: dict[int, Ending], number: int = 12, **told: Any) -> list[EpisodeRecord]:
    """The episodes of a cell, of which some fail."""
    return [record(seed, failing.get(seed, Ending.SUCCESS), **told) for seed in range(number)]


FULL = episodes({4: Ending.COLLISION})
DEGRADED = episodes(
    {1: Ending.TIMEOUT, 2: Ending.OFF_ROAD, 3: Ending.ERROR, 4: Ending.COLLISION}, variant="no_negotiation/own_view"
)
FCFS = episodes({}, method="fcfs", variant="", reasoner="none", faster=-1.5, counts={"nodes": 3, "cavs": 7})
MODEL = [
    record(seed, reasoner="gpt-4o-mini", counts={**ASKED, **({"unpriced_calls": 3} if seed == 1 else {})})
    for seed in range(3)
]
PRICED = episodes({1: Ending.ERROR}, 3, reasoner="gpt-4o-mini", counts=ASKED, method="tell", variant="")
DILU = episodes(dict.fromkeys(range(8), Ending.COLLISION), method="dilu-rule", variant="")
MERGE = episodes({7: Ending.TIMEOUT}, scenario="merge", memory="frozen abc, 2 interactions", counts={"recalled": 5})


SCREENS: list[PrintedTable] = []
"""What has been printed."""


def printed(*tables: PrintedTable | None) -> str:
    """What a pipe gets."""
    stream = io.StringIO()
    for shown in filter(None, tables):
        SCREENS.append(shown)
        print_table(shown, stream)
    return stream.getvalue()


def tables() -> dict[str, str]:
    """All tables by the names of their files."""
    found: dict[str, str] = {}
    paper = read_paper(experiments_dir())
    full, degraded, fcfs, merge, dilu = map(CellResults, (FULL, DEGRADED, FCFS, MERGE, DILU))
    without = CellResults([replace(r, variant="no_negotiation") for r in MERGE])
    values = [{"scenario.cavs": c, "cda.own_order": o} for c, o in (("4", "1"), ("8", "1"), ("8", "own"))]
    runs: dict[str, tuple[list[CellResults], dict[str, Any]]] = {
        "run": ([full], {}),
        "ablation": ([full, degraded, merge, without], {}),
        "sweep": (
            [replace(cell, swept=swept) for cell, swept in zip((full, degraded, fcfs), values, strict=True)],
            {"metrics": "authors", "notes": ["A note."]},
        ),
        "model": ([CellResults(MODEL), CellResults(PRICED), full, dilu], {}),
    }
    for name, (cells, more) in runs.items():
        made = run_tables(cells, paper, **more)
        found[f"{name}-episodes.csv"], found[f"{name}-summary.csv"] = made.episodes.csv(), made.summary.csv()
        found[f"{name}-summary.md"], found[f"{name}-printed.txt"] = markdown_text(made.page), printed(made.printed)
    found |= _comparisons() | _models()
    loads = [
        (cavs, CellResults([replace(r, scenario=s) for r in cell[: cavs + 3]], {"environment.x": x}, cpu=cavs / 1000))
        for s, x in (("intersection", "1"), ("intersection", "2"), ("merge", "1"))
        for cavs in (4, 8)
        for cell in (FCFS, FULL, MODEL, *([DILU] if s == "merge" else []))
    ]
    rows = load_rows(loads, ("fcfs", "mcts", "dilu", "codriving"))
    swept = ["environment.x"]
    found["load.csv"] = load_table(rows, (4, 8), swept).csv()
    found["load.md"] = markdown_text(print_loads(rows, (4, 8), "standard", swept))
    found["load-printed.txt"] = printed(*print_each_load(rows, (4, 8), "standard", swept))
    found |= _learning() | _stress()
    timings = [timing_of(2.0, [0.25, 0.75], [0.125, 0.375]), None, timing_of(1.0, [], [])]
    timed = [TimedEpisode(r, timing, {"scenario.cavs": "8"}) for r, timing in zip(FULL, timings, strict=False)]
    found["timing.csv"] = table(timing_columns(["scenario.cavs"]), timed).csv()
    kept = [SimpleNamespace(count=count) for count in (2, 1, 1)]
    reading = SimpleNamespace(
        snapshot=SimpleNamespace(experiences=kept, digest="0123456789abcdef"),
        verdicts={("eased", "SLOWER"): 3, ("intensified", "FASTER"): 1},
        interactions=(1, 2),
        path=Path("outputs/memory/a.sqlite"),
    )
    built = [
        BuiltMemory("merge", "codriving full", "rules", cast(Any, reading), CellResults(FULL, {"cda.x": x}))
        for x in ("1", "2")
    ]
    asked = BuiltMemory(
        "merge", "codriving full", "gpt-4o-mini", cast(Any, reading), CellResults(MODEL, {"cda.x": "1"})
    )
    found["memory.md"] = markdown_text(print_built(built))
    found["memory-printed.txt"] = printed(print_built([*built, asked]))
    return found


def _comparisons() -> dict[str, str]:
    paper = read_paper(experiments_dir())
    found = {}
    full = CellResults(FULL, cpu=0.0205)
    blocks = {
        "comparison": [[CellResults(FCFS, cpu=0.0042), full, CellResults(DILU)]],
        "comparison-model": [
            [CellResults(MODEL, {"scenario.cavs": c}), CellResults(PRICED, {"scenario.cavs": c}, cpu=0.1)]
            for c in ("4", "8")
        ],
        "comparison-scenarios": [
            [CellResults(MERGE)],
            [CellResults(FULL), CellResults(DEGRADED), CellResults([replace(r, method="a") for r in FULL])],
        ],
    }
    for name, entries in blocks.items():
        swept = ["scenario.cavs"] if "model" in name else []
        methods = ("fcfs", "madqn", "dilu", "codriving")
        rows = with_corrected([row for block in entries for row in comparison_rows(block, methods, paper)])
        found[f"{name}.csv"] = comparison_table(rows, swept).csv()
        kept, screen = (print_comparison(rows, "standard", swept, screen) for screen in (False, True))
        against = print_pairs(rows, "standard", swept)
        found[f"{name}.md"] = markdown_text(kept) + (markdown_text(against, level=2) if against else "")
        found[f"{name}-printed.txt"] = printed(screen, against)
    return found | _suites(paper)


WHOSE = {"model_decisions": 40, "mended_decisions": 4, "plain_decisions": 30, "single_decisions": 20,
         "fallback_decisions": 10, "decisions_as_rules": 30, "model_pairs": 19, "mended_pairs": 0, "repaired_pairs": 1,
         "fallback_pairs": 0, "pairs_as_rules": 10, "cached_tokens": 1000, "reasoning_tokens": 70, "cut_off": 2,
         "withheld": 0}  # fmt: skip


def _models() -> dict[str, str]:
    """A model driven three times, one of a version that did not count, a control that decides all, and the rules."""
    told = {"counts": {**ASKED, **WHOSE}, "variant": "full"}
    every = {"model_decisions": 9, "model_pairs": 9, "decisions_as_rules": 3, "pairs_as_rules": 9, "model_calls": 9}
    cells = [
        CellResults(episodes({2: Ending.TIMEOUT}, reasoner="openai/toy", faster=1.0, **told)),
        CellResults(episodes({}, reasoner="old", counts=ASKED)),
        CellResults(episodes({4: Ending.COLLISION, 5: Ending.COLLISION}, reasoner="control first", counts=every)),
        CellResults(FULL),
    ]
    rows = model_rows([(cell, Repetition(3, 7, 8, 20, 24) if k == 0 else None) for k, cell in enumerate(cells)])
    kept, screen = (print_models(rows, cells, "standard", (), ["A note."], s) for s in (False, True))
    return {
        "models.csv": model_table(rows).csv(),
        "models.md": markdown_text(kept),
        "models-printed.txt": printed(screen),
    }


def _suites(paper: Paper) -> dict[str, str]:
    """Two suites: FCFS loses on 8 seeds in the second one, which counts as 0.0156 with two rows."""
    full = _many("codriving", "rules")
    blocks = {"calm": [_many("fcfs", "none"), full], "wild": [_many("fcfs", "none", 8), full]}
    rows = with_corrected(
        [
            row
            for name, cells in blocks.items()
            for row in comparison_rows([CellResults(cell, {"suite": name}) for cell in cells], ("codriving",), paper)
        ]
    )
    tables, pages = [], []
    for name in blocks:
        condition = Condition(name, f"What {name} is.", last=name == "wild")
        members = [row for row in rows if row.swept["suite"] == name]
        tables += [
            print_comparison(members, "standard", (), False, condition),
            print_pairs(members, "standard", (), condition),
        ]
    pages = [markdown_text(each, level=2) for each in tables if each]
    csv = comparison_table(rows, ["suite"]).csv()
    return {"comparison-suites.csv": csv, "comparison-suites.md": "\n".join(pages)}


def _many(method: str, reasoner: str, lost: int = 0) -> list[EpisodeRecord]:
    """Twelve episodes, the first of which are timeouts; those that succeed have no near miss but for the last."""
    endings = [Ending.TIMEOUT if seed < lost else Ending.SUCCESS for seed in range(12)]
    made = [record(seed, ending, method, "", reasoner) for seed, ending in enumerate(endings)]
    return [replace(r, scores={"standard": replace(r.scores["standard"], clean=lost <= r.seed < 11)}) for r in made]


def _learning() -> dict[str, str]:
    paper = read_learning(experiments_dir())
    cells = []
    for setting, (scenario, few, many) in enumerate((("merge", DILU, FULL), ("highway", FULL, FULL))):
        for n, records in ((0, few), (10, many)):
            labels = {"scenario": scenario, "method": "codriving", "variant": "full", "memory": f"frozen {n}"}
            told = [replace(r, counts={"recalled": n}, **labels) for r in records]
            cells.append(LearningRow(CellResults(told, {"cda.x": "1"}), n, setting, 5))
    rows = learning_rows(cells, paper)
    table = print_learning(rows, "standard", ["cda.x"])
    return {
        "learn.csv": learning_table(rows, ["cda.x"]).csv(),
        "learn.md": markdown_text(table),
        "learn-printed.txt": printed(table),
    }


def _stress() -> dict[str, str]:
    """Two axes: fcfs breaks in success, codriving in clean success alone, and one curve is of too few seeds."""
    levels = {"noise": (0.0, 0.3, 1.0, 2.0), "channel": ("perfect", "poor")}
    axes = [
        StressAxis(key, f"{key} of messages", "m" if key == "noise" else "", f"What {key} is.", _levels_of(values))
        for key, values in levels.items()
    ]
    lost = {
        ("codriving", "rules"): ((0, 0), (0, 1), (0, 2), (0, 9)),
        ("fcfs", "none"): ((1, 1), (1, 1), (6, 2), (9, 2)),
    }
    curves = [
        StressCurve(
            axis, {k: CellResults(_stressed(*who, *lost[who][k], 12)) for k in range(len(axis.levels))}, {"x": "1"}
        )
        for axis in axes
        for who in lost
    ]
    few = {k: CellResults(_stressed("mcts", "none", 0, 0, 9)) for k in range(4)}
    curves.insert(2, StressCurve(axes[0], few, {"x": "2"}))
    found = {
        "stress.csv": stress_table(curves, ["x"]).csv(),
        "stress-breaking.csv": breaking_table(curves, ["x"]).csv(),
    }
    tables = []
    for axis in axes:
        own = [curve for curve in curves if curve.axis is axis]
        tables += print_stress(own, "standard", ["x"], stress_notes(curves) if axis is axes[-1] else ())
    found["stress.md"] = "\n".join(markdown_text(table, level=2) for table in tables)
    return found | {"stress-printed.txt": printed(*tables)}


def _levels_of(values: Sequence[float | str]) -> tuple[StressLevel, ...]:
    return tuple(StressLevel(value, ()) for value in values)


def _stressed(method: str, reasoner: str, lost: int, unclean: int, seeds: int) -> list[EpisodeRecord]:
    """Episodes of which the first are timeouts and the next ones not clean."""
    endings = [Ending.TIMEOUT if seed < lost else Ending.SUCCESS for seed in range(seeds)]
    made = [record(seed, ending, method, "", reasoner) for seed, ending in enumerate(endings)]
    clean = [seed >= lost + unclean for seed in range(seeds)]
    return [
        replace(r, scores={"standard": replace(r.scores["standard"], clean=c)})
        for r, c in zip(made, clean, strict=True)
    ]
