"""The control without a method: it decides nothing, and its episodes are kept like all others."""

from pathlib import Path

import codriving


def test_its_episodes_are_kept_like_all_others(tmp_path: Path) -> None:
    asked = ("method=idm", "scenario.cavs=2", "scenario.hdvs=[2,2]", "seed=10000", "episodes=1", "launcher=serial")
    driven = codriving.run(*asked, f"output={tmp_path}", "run=one")
    row = driven.summary.iloc[0]
    assert row[["method", "variant", "reasoner", "completed"]].tolist() == ["idm", "control", "none", 1]
    line = next(driven.folder.glob("episodes/intersection-idm-control/10000/decisions.jsonl")).read_text("utf-8")
    assert '"id": "CAV1", "action": "", "reason": "drives as a human driver does, by IDM and the right of way"' in line
