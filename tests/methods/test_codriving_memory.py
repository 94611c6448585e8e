"""The memory in the pipeline: what is recalled, what is learnt, and a mistake that is not repeated."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from driven import Episode, drive
from remembered import configured_memory, description, experience, filled, frozen, online
from worlds import FULL, Junction

from codriving.datatypes.experience import Experience, Interaction, Memory, Verdict
from codriving.datatypes.parts import CaseMemory
from codriving.datatypes.record import Ending
from codriving.datatypes.situation import Situation
from codriving.datatypes.world import Action
from codriving.llm.language_model import Offline
from codriving.memory.embedders import FeatureEmbedder
from codriving.memory.online import OnlineMemory
from codriving.memory.snapshot import open_snapshot
from codriving.methods.codriving import CoDriving
from codriving.reasoning.sharing.sharing import CdaLevel

NO_CHECK = {"safety_check": False}


def method(memory: CaseMemory | None, **change: Any) -> CoDriving:
    """The method with a memory, at any CDA level."""
    return CoDriving(CdaLevel(**{**FULL, **change}), Offline(), memory, 1.5)


def learn(junction: Junction, made: CoDriving, seed: int) -> Episode:
    """Drive an episode to its end and learn from it."""
    episode = drive(junction.environment, made, seed)
    assert episode.outcome is not None
    made.conclude(episode.worlds[-1], episode.outcome)
    return episode


class Everything(CaseMemory):
    """A memory that recalls the same for every situation, and keeps what it is given."""

    label, learns, reflections = "everything", True, 0

    def __init__(self, memories: Sequence[Memory] = ()) -> None:
        self.memories, self.learnt, self.begun = tuple(memories), [], []  # type: ignore[var-annotated]

    def begin(self, interaction: Interaction) -> None:
        """Note the episode."""
        self.begun.append(interaction)

    def recall(self, situations: Sequence[Situation]) -> list[tuple[Memory, ...]]:
        """Recall the same for each."""
        return [self.memories] * len(situations)

    def learn(self, experiences: Sequence[Experience]) -> int:
        """Keep it."""
        self.learnt.append(list(experiences))
        return len(experiences)


def ending(episode: Episode) -> Ending | None:
    """How an episode ended."""
    return episode.outcome.ending if episode.outcome is not None else None


class Practice(OnlineMemory):
    """A memory for driving one episode again and again; each drive counts as an interaction of its own."""

    def begin(self, interaction: Interaction) -> None:
        """Recall everything, and keep it beside what the drives before have left."""
        with self._store() as store:
            done = store.snapshot().interactions
        super().begin(replace(interaction, seed=interaction.seed + done))


def test_a_remembered_mistake_is_not_repeated(merge: Junction, tmp_path: Path) -> None:
    """An episode again and again: what led to its collision is not done again, and in the end it has none.

    Without the safety check it ends in a collision every time if nothing is learnt.
    """
    seed, path = 12_002, tmp_path / "m.sqlite"
    before = drive(merge.environment, method(None, **NO_CHECK), seed)
    made = method(Practice(**{**configured_memory("online"), "file": str(path)}), **NO_CHECK)
    drives = [learn(merge, made, seed)]
    assert ending(drives[0]) is Ending.COLLISION
    assert drives[0].actions == before.actions
    kept = [entry.experience for entry in open_snapshot(path, FeatureEmbedder()).experiences]
    mistake = next(e for e in kept if e.effect.to_blame)
    while ending(drives[-1]) is Ending.COLLISION and len(drives) < 5:
        drives.append(learn(merge, made, seed))
    both = zip(drives[1].actions, before.actions, strict=False)
    changed = [k for k, (now, then) in enumerate(both) if now != then]
    assert changed
    assert changed[0] <= mistake.step, f"{mistake.ego} did again what led to the collision"
    assert ending(drives[-1]) is Ending.SUCCESS, [ending(d) for d in drives]


def test_without_a_memory_nothing_changes(junction: Junction) -> None:
    none, empty = (drive(junction.environment, method(m), 10_004, 12) for m in (None, Everything()))
    assert none.actions == empty.actions
    assert "recalled" not in none.steps[0].counts
    assert empty.steps[0].counts == {"recalled": 0, "reconsidered": 0}


def test_both_columns_of_retrieval_and_what_changed_are_written_down(junction: Junction, tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    learn(junction, method(online(path)), 10_004)
    episode = drive(junction.environment, method(frozen(path)), 10_004, 20)
    cavs = [cav for step in episode.steps for cav in step.as_dict()["cavs"]]
    told = [cav for cav in cavs if cav["memories"]]
    assert told
    for cav in cavs:
        assert len(cav["memories"]) == len(cav["similarities"]) <= 5
        assert cav["similarities"] == sorted(cav["similarities"], reverse=True)
        assert all(0.94 <= s <= 1 for s in cav["similarities"])
        assert all(isinstance(text, str) and text for text in cav["memories"])
        assert isinstance(cav["recalled"], list)
    counted = [step.counts for step in episode.steps]
    assert sum(c["recalled"] for c in counted) == sum(len(cav["memories"]) for cav in cavs)
    assert sum(c["reconsidered"] for c in counted) == sum(bool(cav["recalled"]) for cav in cavs)


def test_what_speaks_against_everything_but_one_action_leaves_that_one(junction: Junction) -> None:
    against = [
        Memory(k, "a lesson", action, Verdict.INTENSIFIED, 0.99, 4)
        for k, action in enumerate((Action.FASTER, Action.IDLE))
    ]
    episode = drive(junction.environment, method(Everything(against)), 10_004, 3)
    taken = {action for step in episode.actions for action in step.values()}
    assert taken == {Action.SLOWER}
    assert any(d.recalled for step in episode.steps for d in step.decisions)


def test_an_episode_is_learnt_from_once_with_its_provenance(junction: Junction) -> None:
    memory = Everything()
    made = method(memory, negotiation=False)
    episode = learn(junction, made, 10_005)
    (experiences,) = memory.learnt
    assert memory.begun == [Interaction("intersection", 10_005, "codriving", "no_negotiation/own_view", "rules")]
    assert experiences == sorted(experiences, key=lambda e: (e.step, e.ego))
    assert all(e.verdict is not Verdict.NEUTRAL for e in experiences)
    for e in experiences:
        assert episode.steps[e.step].actions[e.ego] is e.action


def test_what_is_remembered_of_a_situation_is_what_the_cav_was_told(junction: Junction) -> None:
    """Without intent sharing no conflict is seen, so none is remembered, though effects are judged by them."""
    memory = Everything()
    learn(junction, method(memory, intent_sharing=False), 10_001)
    (experiences,) = memory.learnt
    assert experiences
    assert {e.description.kinds["relation"] for e in experiences} == {"none"}
    assert any(e.effect.dttcp_before is not None for e in experiences)


def test_a_snapshot_is_never_changed(junction: Junction, tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    learn(junction, method(online(path)), 10_004)
    before, stamp = path.read_bytes(), path.stat().st_mtime_ns
    made = method(frozen(path))
    for seed in (10_004, 10_006):
        learn(junction, made, seed)
    assert (path.read_bytes(), path.stat().st_mtime_ns) == (before, stamp)


def test_a_snapshot_gives_the_same_in_every_order(junction: Junction, tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    learn(junction, method(online(path)), 10_004)
    made = method(frozen(path))
    forth = {seed: drive(junction.environment, made, seed, 15).actions for seed in (10_004, 10_006)}
    back = {seed: drive(junction.environment, method(frozen(path)), seed, 15).actions for seed in (10_006, 10_004)}
    assert forth == back


def test_online_an_episode_recalls_what_smaller_seeds_have_left(junction: Junction, tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    made = method(online(path))
    first, second = (learn(junction, made, seed) for seed in (10_004, 10_005))
    assert sum(s.counts["recalled"] for s in first.steps) == 0
    assert sum(s.counts["recalled"] for s in second.steps) > 0
    whole = open_snapshot(path, FeatureEmbedder()).digest
    # Driven again, as after an interruption between the two: the same, as if nothing had happened.
    again = learn(junction, method(online(path)), 10_005)
    assert again.actions == second.actions
    assert open_snapshot(path, FeatureEmbedder()).digest == whole


def test_labels_for_tables(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience(description())])
    digest = open_snapshot(path, FeatureEmbedder()).digest
    assert method(None).remembers == ""
    assert method(online(path)).remembers == "online"
    assert method(frozen(path)).remembers == f"frozen {digest[:8]}, 1 interactions"
    assert method(frozen(path, interactions=0)).remembers.endswith(", 0 interactions")
