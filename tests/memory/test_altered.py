"""Memories in which something is mixed up: what is dealt out anew, what stays, and the one rule that is left."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from remembered import description, experience, filled, frozen

from codriving.datatypes.experience import Verdict
from codriving.datatypes.world import Action
from codriving.memory.altered import Alteration, altered
from codriving.memory.embedders import FeatureEmbedder
from codriving.memory.snapshot import Snapshot, open_snapshot

E, X = Verdict.EASED, Verdict.INTENSIFIED

TOLD = [description(dttcp=0.5 * k, speed=4.0 + k) for k in range(12)]
ACTIONS = [Action.FASTER, Action.SLOWER, Action.LANE_LEFT, Action.LANE_RIGHT] * 3
VERDICTS = [X, E, X, X, E, E, X, E, X, E, E, X]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A memory of twelve situations that are not alike."""
    made = [experience(d, a, v, step=k) for k, (d, a, v) in enumerate(zip(TOLD, ACTIONS, VERDICTS, strict=True))]
    return filled(tmp_path / "m.sqlite", made)


def parts(snapshot: Snapshot) -> tuple[list[str], list[Action], list[tuple[Verdict, str]]]:
    """Situations, actions and what came of them, in the order in which they are kept."""
    made = [entry.experience for entry in snapshot.experiences]
    return [e.description.text for e in made], [e.action for e in made], [(e.verdict, e.lesson) for e in made]


@pytest.mark.parametrize(("how", "moved"), [("verdicts", 2), ("situations", 0)])
def test_one_thing_is_dealt_out_anew_and_all_else_stays(how: Alteration, moved: int, path: Path) -> None:
    plain = open_snapshot(path, FeatureEmbedder())
    before, after = parts(plain), parts(altered(plain, how))
    for k in range(3):
        assert Counter(after[k]) == Counter(before[k])
        assert (after[k] == before[k]) == (k != moved)
    again = altered(open_snapshot(path, FeatureEmbedder()), how)
    assert parts(again) == after, "it follows from what the file holds"


def test_shuffled_situations_are_found_where_they_now_are(path: Path) -> None:
    plain = open_snapshot(path, FeatureEmbedder())
    mixed = altered(plain, "situations")
    vectors = FeatureEmbedder().embed(TOLD)
    found = [mixed.search(vectors, 1, 0.9)[k][0] for k in range(12)]
    texts = parts(mixed)[0]
    for told, memory in zip(TOLD, found, strict=True):
        place = texts.index(told.text)
        assert memory.action is parts(mixed)[1][place]
    assert [m.action for m in found] != ACTIONS


def test_the_rule_is_what_was_a_mistake_most_often_and_lane_changes_are_one(path: Path) -> None:
    rule = altered(open_snapshot(path, FeatureEmbedder()), "rule")
    # FASTER was a mistake twice, LANE_LEFT twice and LANE_RIGHT twice.
    (first, second), *others = rule.search(np.zeros((3, rule.dimension), dtype=np.float32), 1, 0.99)
    assert [(m.action, m.verdict, m.count, m.similarity) for m in (first, second)] == [
        (Action.LANE_LEFT, X, 2, 1.0),
        (Action.LANE_RIGHT, X, 2, 1.0),
    ]
    assert others == [(first, second)] * 2, "the same in each situation, however unlike"


def test_where_nothing_was_a_mistake_there_is_no_rule(tmp_path: Path) -> None:
    path = filled(tmp_path / "e.sqlite", [experience(TOLD[0], Action.FASTER, E)])
    assert altered(open_snapshot(path, FeatureEmbedder()), "rule").search(np.zeros((1, 3), dtype=np.float32), 5, 0) == [
        ()
    ]


def test_tables_tell_them_apart_and_nothing_is_altered_unless_asked(path: Path) -> None:
    labels = [frozen(path, control=how).label for how in ("none", "verdicts", "situations", "rule")]
    words = ("", ", shuffled verdicts", ", shuffled situations", ", one rule in their place")
    assert labels == [labels[0] + word for word in words]
    plain = open_snapshot(path, FeatureEmbedder())
    assert altered(plain, "none") is plain
