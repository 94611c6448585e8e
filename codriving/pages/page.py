"""One page of HTML that asks nothing of the network: everything is in it, and everything of a run is escaped."""

import base64
import hashlib
import json
import zlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codriving.animation import sentence
from codriving.datatypes import Ending
from codriving.pages.figures import figures
from codriving.pages.parting import choices_in, parting, same_start
from codriving.pages.replay import replay_data, road_data
from codriving.pages.subject import ReportedRow, ReportedRun, pairs
from codriving.reports import Paper, PrintedTable, flow_tables, run_tables
from codriving.runs import read_decisions, read_trajectory, read_transcript
from codriving.version import __version__

HERE = Path(__file__).parent


@dataclass(frozen=True, slots=True)
class Replayed:
    """An episode that the page replays."""

    row: str  # Name of its row
    road: int  # Which of the roads it is on
    twins: Sequence[str]  # The same seed in other rows
    packed: str  # What is drawn, compressed


def report_page(runs: Sequence[ReportedRun], replays: int) -> str:
    """Make the page.

    Args:
        replays: How many episodes can be replayed, those that ended badly first.

    Raises:
        RunFolderError: If a file of an episode is damaged.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    rows = [row for run in runs for row in run.rows]
    chosen = _chosen(rows, replays)
    roads, data = _replays(rows, chosen)
    style, script = (_text(name) for name in ("page.css", "page.js"))
    values = {
        "title": " and ".join(run.name for run in runs),
        "version": __version__,
        "policy": f"default-src 'none'; script-src '{style_hash(script)}'; style-src '{style_hash(style)}'; "
        "img-src data:; base-uri 'none'; form-action 'none'",
        "style": style,
        "script": script,
        "runs": [_run(run) for run in runs],
        "tables": _tables(rows),
        "figures": figures([(row.name, row.results) for row in rows]),
        "partings": [_parted(one, other, data) for one, other in pairs(runs)],
        "episodes": [entry for row in rows for entry in _entries(row, data, len(rows) > 1)],
        "several": len(rows) > 1,
        "names": [row.name for row in rows],
        "endings": sorted({row_.record.outcome.ending.value for row in rows for row_ in row.episodes}),
        "settings": _settings(rows),
        "roads": _json(roads),
        "index": _json([[key, one.road, [t for t in one.twins if t in data], one.row] for key, one in data.items()]),
        "data": [one.packed for one in data.values()],
    }
    environment = Environment(
        loader=FileSystemLoader(HERE),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return environment.get_template("page.html.j2").render(values)


def _text(name: str) -> str:
    return (HERE / name).read_text(encoding="utf-8")


def style_hash(text: str) -> str:
    """Give what a policy calls a text that the page holds."""
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"


def _json(value: object) -> str:
    """Write JSON that ends no element of a page, whatever it holds."""
    text = json.dumps(value, ensure_ascii=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _packed(value: object) -> str:
    # In ASCII, for a text may hold half of a surrogate pair, which has no UTF-8.
    text = json.dumps(value, separators=(",", ":"))
    return base64.b64encode(zlib.compress(text.encode(), 9)).decode()


def _chosen(rows: Sequence[ReportedRow], most: int) -> set[tuple[str, int]]:
    """Choose which episodes are replayed: seed by seed in all rows, those that ended badly first."""
    bad: dict[int, int] = {}
    for row in rows:
        for episode in row.results.episodes:
            seed, good = episode.record.seed, episode.record.outcome.ending in (Ending.SUCCESS, Ending.COUNTED)
            bad[seed] = max(bad.get(seed, 0), 2 if not good else int(episode.clean is False))
    ranked = [(row.name, seed) for seed in sorted(bad, key=lambda s: (-bad[s], s)) for row in rows if seed in row.seeds]
    return set(ranked[:most])


def _replays(
    rows: Sequence[ReportedRow], chosen: set[tuple[str, int]]
) -> tuple[list[dict[str, Any]], dict[str, Replayed]]:
    roads: list[dict[str, Any]] = []
    data: dict[str, Replayed] = {}
    for row in rows:
        road = road_data(row.road_map)
        if road not in roads:
            roads.append(road)
        for episode in row.episodes:
            seed = episode.record.seed
            if (row.name, seed) not in chosen:
                continue
            trajectory = read_trajectory(episode.folder, episode.record)
            if trajectory is None or not trajectory.tracks:
                continue
            lines = read_decisions(episode.folder), read_transcript(episode.folder)
            made = replay_data(episode.record, trajectory, *lines, row.road_map)
            alike = [one for one in rows if one is not row and one.cell.scenario == row.cell.scenario]
            twins = [one.key(seed) for one in alike if (one.name, seed) in chosen]
            packed = _packed({**made, "name": row.name, "seed": seed})
            data[row.key(seed)] = Replayed(row.name, roads.index(road), twins, packed)
    return roads, data


def _tables(rows: Sequence[ReportedRow]) -> list[dict[str, Any]]:
    """The summary as ``summary.md`` has it; flows in a table of their own."""
    found = []
    for flows in (False, True):
        cells = [row.results for row in rows if (row.results.first.outcome.flow is not None) is flows]
        if cells:
            tables = flow_tables(cells, cells[0].metric) if flows else run_tables(cells, Paper(), cells[0].metric)
            found.append(_table(tables.page))
    return found


def _table(table: PrintedTable) -> dict[str, Any]:
    return {
        "title": table.title,
        "columns": [(head, head in table.words) for head in table.columns],
        "rows": [row.cells for row in table.rows],
        "notes": table.notes,
    }


def _run(run: ReportedRun) -> dict[str, Any]:
    manifest = run.manifest
    packages = ", ".join(f"{name} {version}" for name, version in manifest.versions.items())
    said = {
        "experiment": manifest.experiment,
        "begun": manifest.created,
        "seeds": f"{manifest.episodes} from {manifest.first_seed}",
        "behaviour number": str(manifest.behaviour),
        "commit": manifest.commit or "",
        "versions": packages,
    }
    return {"name": run.name, "said": {key: value for key, value in said.items() if value}}


def _entries(row: ReportedRow, data: Iterable[str], several: bool) -> list[dict[str, Any]]:
    """The lines of the list of episodes."""
    found = []
    for scored in row.results.episodes:
        record = scored.record
        key = row.key(record.seed)
        found.append(
            {
                "key": key if key in data else "",
                "row": row.name,
                "seed": record.seed,
                "ending": record.outcome.ending.value,
                "clean": {True: "yes", False: "no", None: ""}[scored.clean],
                "time": f"{record.outcome.time:.1f}",
                "pet": f"{min(scored.pets):.1f}" if scored.pets else "",
                "velocity": f"{sum(scored.velocities) / len(scored.velocities):.1f}" if scored.velocities else "",
                "vehicles": f"{sum(p.kind == 'CAV' for p in record.participants)} + "
                f"{sum(p.kind == 'HDV' for p in record.participants)}",
                "words": sentence(record.outcome, sum(p.kind == "CAV" for p in record.participants)),
            }
        )
    return found


def _parted(one: ReportedRow, other: ReportedRow, data: Iterable[str]) -> dict[str, Any]:
    """Two rows, seed by seed."""
    seeds = sorted(one.seeds.keys() & other.seeds.keys())
    lines = [_pair(one, other, seed, data) for seed in seeds]
    differ = sum(line["endings"][0] != line["endings"][1] for line in lines)
    never = sum(line["state"] == "never" for line in lines)
    moved = sum(line["state"] == "moved" for line in lines)
    said = [f"{len(seeds)} seed{'s' * (len(seeds) != 1)} in both", f"{differ} end{'s' * (differ == 1)} differently"]
    said += [f"{never} with the same decisions throughout"] if never else []
    said += (
        [f"{moved} with other vehicles at the start, so that decisions cannot be set against each other"]
        if moved
        else []
    )
    return {"names": (one.name, other.name), "said": "; ".join(said) + ".", "rows": lines}


def _pair(one: ReportedRow, other: ReportedRow, seed: int, data: Iterable[str]) -> dict[str, Any]:
    episodes = one.seeds[seed], other.seeds[seed]
    starts = [read_trajectory(e.folder, e.record) for e in episodes]
    keys = [row.key(seed) if row.key(seed) in data else "" for row in (one, other)]
    outcomes = [e.record.outcome for e in episodes]
    line: dict[str, Any] = {
        "seed": seed,
        "links": keys,
        "endings": [o.ending.value for o in outcomes],
        "times": [f"{o.time:.1f}" for o in outcomes],
        "pets": [_least(row, seed) for row in (one, other)],
        "state": "moved",
        "time": "",
        "cav": "",
        "words": "other vehicles at the start",
    }
    if starts[0] is None or starts[1] is None:
        return {**line, "state": "undriven", "words": "one of them ended in an error before it began"}
    if not same_start(starts[0], starts[1]):
        return line
    parted = parting(*(choices_in(read_decisions(e.folder)) for e in episodes))
    if parted is None:
        return {**line, "state": "never", "words": "every decision is the same while both are driven"}
    words = ", ".join(f"{cav}: {mine} and {theirs}" for cav, mine, theirs in parted.changes)
    return {**line, "state": "parted", "time": f"{parted.time:.1f}", "cav": parted.changes[0][0], "words": words}


def _least(row: ReportedRow, seed: int) -> str:
    pets = next((e.pets for e in row.results.episodes if e.record.seed == seed), ())
    return f"{min(pets):.1f}" if pets else ""


def _settings(rows: Sequence[ReportedRow]) -> dict[str, list[tuple[str, list[str]]]]:
    """The settings that differ between rows, and those that all have."""
    keys = sorted({key for row in rows for key in row.cell.settings})
    values = [(key, [row.cell.settings.get(key, "") for row in rows]) for key in keys]
    return {
        "differ": [(key, found) for key, found in values if len(set(found)) > 1],
        "same": [(key, found[:1]) for key, found in values if len(set(found)) == 1],
    }
