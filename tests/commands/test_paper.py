"""``codriving experiment paper``: its parts one after another, and the page of what there is so far."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from codriving.commands import paper
from codriving.config.experiments import ExperimentFile
from codriving.errors import ConfigError

SHORT = ["scenario.time_limit=3", "scenario.cavs=2", "launcher=serial"]


def short(spec: ExperimentFile) -> ExperimentFile:
    """A part with few rows on two seeds."""
    kept = [token for token in spec.common if not token.startswith(("episodes=", "interactions=", "controls="))]
    words = ["interactions=0,1"] if spec.table == "learning" else []
    rows = dict(list(spec.rows.items())[-2:])
    columns = {"merge": ("scenario=merge",)} if spec.columns else {}
    return replace(spec, common=(*kept, *words, "controls=false", "episodes=1"), rows=rows, columns=columns)


@pytest.fixture
def driven(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a page with a part of each kind."""
    monkeypatch.chdir(tmp_path)
    kinds = ("ablation", "case_memory", "comparison")
    found = [short(spec) for spec in paper.papers_experiments() if spec.name in kinds]
    monkeypatch.setattr(paper, "papers_experiments", lambda: found)
    return tmp_path / "outputs" / "paper"


def test_they_come_in_the_papers_order() -> None:
    assert [(spec.name, spec.shows[:7]) for spec in paper.papers_experiments()] == [
        ("ablation", "Fig. 5"),
        ("case_negotiation", "Fig. 6"),
        ("learning", "Fig. 7"),
        ("case_memory", "Fig. 8"),
        ("comparison", "Table I"),
        ("single_vehicle", "the ext"),
    ]


def test_all_parts_are_driven_and_stand_on_one_page_beside_the_papers_numbers(
    driven: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert paper.run_paper(SHORT) == 0
    said = capsys.readouterr()
    assert "ablation, 1 of 3: Fig. 5.\n" in said.err
    assert said.out.splitlines()[-1] == "Page: outputs/paper/index.html, 3 of 3 parts."
    text = (driven / "index.html").read_text()
    assert re.findall(r'<section id="(\w+)">', text) == ["ablation", "case_memory", "comparison"]
    assert "No language model drove here: llm=offline are the built-in rules." in text
    assert "dilu-rule: built-in rules in the place of a language model; not that method." in text
    assert "Not driven yet" not in text
    links = [link.partition("#")[0] for link in re.findall(r'href="([^"#]+?)"', text) if not link.startswith("data:")]
    assert len(links) >= 9
    assert all((driven / link).is_file() for link in links)
    ((page, key),) = re.findall(r'href="(runs/case_memory/report.html)#ep=([^&]+)&amp;', text)
    assert f'"{key}"' in (driven / page).read_text(), "the start can be replayed there"
    assert text.count('<img src="data:image/png;base64,') == 6
    assert 'src="http' not in text
    assert "<script" not in text
    comparison = text[text.index('<section id="comparison">') :]
    ours = r"DiLu \(dilu-rule\)</th><td[^>]*>\d+ \(\d+ to \d+\)"
    assert re.search(rf'{ours}<span class="theirs (yes|no)">38 %<', comparison)
    assert paper.run_paper(SHORT) == 0
    assert capsys.readouterr().out.count("Nothing to do: all") == 3
    assert (driven / "index.html").read_text() == text, "the same command makes the same page"


def test_what_is_not_driven_yet_is_said(
    driven: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(paper, "_drive", lambda *_: (0, 0))
    assert paper.run_paper([]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "Page: outputs/paper/index.html, 0 of 3 parts."
    text = (driven / "index.html").read_text()
    assert text.count("Not driven yet.") == 3
    assert "Not driven yet: Fig. 5; Fig. 8; Table I and Fig. 9. The same command goes on." in text


@pytest.mark.parametrize("token", ["run=x", "experiment=mine", "shard=1/2"])
def test_its_folders_are_its_own(token: str) -> None:
    with pytest.raises(
        ConfigError, match=f"experiment paper sets {token.partition('=')[0]} itself; output=DIR chooses"
    ):
        paper.run_paper([token])
