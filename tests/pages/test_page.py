"""The page as bytes: whole, closed to the outside, escaped, and the same each time."""

import base64
import hashlib
import json
import re
import zlib
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from codriving.commands.report import ReportOptions, run_report
from codriving.experiment.stored import find_episode, read_episode
from codriving.runs.episode_folder import Timing, read_decisions, write_episode

HOSTILE = '</script><script>alert(1)</script><img src="http://x.test/a" onerror=alert(2)>'
HALF = HOSTILE + "\ud83d"  # As a file of JSON may have it, in ASCII


class Elements(HTMLParser):
    """All elements with their attributes, and the text in each script and style."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.inside: list[tuple[dict[str, str | None], str]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        if data.strip() and self.found[-1][0] in ("script", "style"):
            self.inside.append((self.found[-1][1], data))


def episodes_in(text: str) -> dict[str, dict[str, Any]]:
    """The replays that a page holds, by their names in links."""
    found = re.search(r'<script type="application/json" id="index">(.*?)</script>', text)
    assert found is not None
    packed = re.findall(r'<script type="text/plain" id="e\d+">(.*?)</script>', text)
    names = [entry[0] for entry in json.loads(found[1])]
    return {name: json.loads(zlib.decompress(base64.b64decode(one))) for name, one in zip(names, packed, strict=True)}


def test_nothing_of_it_lies_elsewhere(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert text.startswith("<!doctype html>")
    elements = Elements(text)
    for tag, attributes in elements.found:
        assert not {"style", "onclick", "onerror", "onload"} & attributes.keys(), tag
        assert tag not in ("iframe", "object", "embed", "base")
        assert "src" not in attributes, tag
        assert (attributes.get("href") or "#").startswith(("#", "data:,")), (tag, attributes)
    (policy,) = [a["content"] for tag, a in elements.found if tag == "meta" and "http-equiv" in a]
    assert policy is not None
    assert policy.startswith("default-src 'none'; ")
    run = [text for attributes, text in elements.inside if "type" not in attributes]
    assert len(run) == 2
    for text in run:
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert f"'sha256-{digest}'" in policy
        assert not re.search(r"\b(eval|innerHTML|fetch|XMLHttpRequest|import)\b", text)


def test_the_same_run_gives_the_same_bytes(page: Path, two_runs: tuple[Path, Path], tmp_path: Path) -> None:
    run_report(two_runs, ReportOptions(out=tmp_path / "again.html"))
    assert (tmp_path / "again.html").read_bytes() == page.read_bytes()


def test_every_episode_is_there_and_its_twin(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    cell = "intersection-codriving-full"
    names = [f"{run}/{cell}/{seed}" for run in ("plain", "talking") for seed in (20000, 20001)]
    made = episodes_in(text)
    assert list(made) == names
    assert f'<a href="#ep={names[0]}">20000</a>' in text
    # The link of the first decision that differs opens both there.
    assert re.search(rf'<a href="#ep={names[0]}&amp;t=[\d.]+&amp;cav=CAV\d&amp;with={names[2]}">', text)
    cavs = [entry for one in made.values() for step in one["steps"] for entry in step["cavs"].values()]
    held = {part["h"] for entry in cavs for part in entry["s"]}
    assert {"Actions", "Passing order", "Conflicts", "What it knew", "Messages about orders"} <= held


def test_twenty_episodes_stay_below_5_mb(page: Path) -> None:
    """Those of 8 s here are longer as a page than a third of those that are driven to the end."""
    packed = re.findall(r'<script type="text/plain" id="e\d+">(.*?)</script>', page.read_text(encoding="utf-8"))
    assert 3 * 20 * max(map(len, packed)) < 5_000_000


def _halve(folder: Path) -> None:
    """Put half of a surrogate pair into each reason."""
    path, sums = folder / "decisions.jsonl", folder / "SHA256SUMS"
    before = path.read_bytes()
    path.write_bytes(before.replace(b'onerror=alert(2)>"', b'onerror=alert(2)>\\ud83d"'))
    named = [hashlib.sha256(content).hexdigest() for content in (before, path.read_bytes())]
    sums.write_text(sums.read_text(encoding="utf-8").replace(*named), encoding="utf-8")


def test_what_a_run_says_stays_text(two_runs: tuple[Path, Path], tmp_path: Path) -> None:
    episode = find_episode(two_runs[0], None, 20000)
    record, trajectory = read_episode(episode)
    lines = [dict(line) for line in read_decisions(episode.folder)]
    lines[0] = {**lines[0], "cavs": [{**entry, "reason": HOSTILE} for entry in lines[0]["cavs"]]}
    asked = {"time": 0.0, "purpose": HOSTILE, "subject": "", "value": None, "calls": [{"text": HOSTILE}]}
    run = tmp_path / "evil"
    folder = run / "episodes" / "intersection-codriving-full" / "20000"
    folder.parent.mkdir(parents=True)
    manifest = json.loads((two_runs[0] / "manifest.json").read_text(encoding="utf-8"))
    manifest["versions"]["codriving"] = HOSTILE
    (run / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    write_episode(folder, record, trajectory, lines, Timing(1.0, 1, None, None), transcript=[asked])
    _halve(folder)
    run_report([run], ReportOptions(out=tmp_path / "evil.html"))
    text = (tmp_path / "evil.html").read_text(encoding="utf-8")
    assert "<img" not in text
    assert "alert(1)</script>" not in text
    elements = Elements(text)
    assert [a.get("type") for tag, a in elements.found if tag == "script"] == [
        *("application/json", "application/json", "text/plain"),
        None,
    ]
    first = episodes_in(text)["intersection-codriving-full/20000"]["steps"][0]["cavs"]["CAV1"]
    assert first["r"] == HALF
    assert ["answer", HOSTILE] in [text for part in first["s"] for text in part.get("t", ())]


def test_bad_endings_are_replayed_first(two_runs: tuple[Path, Path], tmp_path: Path) -> None:
    done = run_report(two_runs, ReportOptions(out=tmp_path / "two.html", replays=2))
    assert "4 episodes, 2 of them to replay" in done
    names = list(episodes_in((tmp_path / "two.html").read_text(encoding="utf-8")))
    # Both of one seed rather than two of one run, so that they can be seen beside one another.
    assert [name.split("/")[2] for name in names] == ["20000", "20000"]


@pytest.mark.parametrize("word", ["Where they part", "codriving full", "v2x.loss", "Timeout after 8.0 s"])
def test_tables_and_settings_are_there_without_a_script(word: str, page: Path) -> None:
    assert word in page.read_text(encoding="utf-8").partition('<script type="application/json"')[0]
