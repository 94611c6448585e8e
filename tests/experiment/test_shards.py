"""What a shard is, by its text or by the variables of Slurm, and what no shard can drive."""

from pathlib import Path

import pytest

import codriving
from codriving.commands.bounds import BoundOptions, run_bound
from codriving.commands.learn import run_learn
from codriving.commands.memory_build import build_points
from codriving.commands.run import run_experiment
from codriving.config.compose import compose
from codriving.config.sweep import expand
from codriving.errors import ConfigError
from codriving.experiment.plan import make_plan
from codriving.experiment.shards import refuse_part, shard_of
from codriving.runs.parts import Shard


def array(**values: object) -> dict[str, str]:
    return {f"SLURM_ARRAY_TASK_{name}": str(value) for name, value in values.items()}


def test_a_shard_is_what_is_written_and_none_is_everything() -> None:
    assert shard_of("2/4", {}) == Shard(2, 4)
    assert shard_of(None, array(ID=1, MIN=1, STEP=1, COUNT=4)) is None


@pytest.mark.parametrize(
    ("variables", "shard"),
    [
        (array(ID=1, MIN=1, MAX=4, STEP=1, COUNT=4), Shard(1, 4)),
        (array(ID=4, MIN=1, MAX=4, STEP=1, COUNT=4), Shard(4, 4)),
        (array(ID=0, MIN=0, MAX=3, STEP=1, COUNT=4), Shard(1, 4)),
        (array(ID=20, MIN=10, MAX=30, STEP=10, COUNT=3), Shard(2, 3)),
        (array(ID=5, MIN=1, STEP=2, COUNT=3), Shard(3, 3)),
    ],
)
def test_slurm_says_which_shard_a_task_is(variables: dict[str, str], shard: Shard) -> None:
    assert shard_of("slurm", variables) == shard


@pytest.mark.parametrize(
    ("variables", "said"),
    [
        ({}, "SLURM_ARRAY_TASK_ID is not set; submit the job with sbatch --array=1-4, or write shard=1/4"),
        (array(ID=1, MIN=1, COUNT=4), "SLURM_ARRAY_TASK_STEP is not set"),
        (array(ID="one", MIN=1, STEP=1, COUNT=4), "SLURM_ARRAY_TASK_ID must be a whole number, got 'one'"),
        (array(ID=2, MIN=2, MAX=2, STEP=1, COUNT=1), "for instance shard=2/4"),
        (array(ID=3, MIN=1, MAX=7, STEP=1, COUNT=3), "an array in equal steps"),
        (array(ID=2, MIN=1, MAX=5, STEP=2, COUNT=3), "an array in equal steps"),
        (array(ID=9, MIN=1, STEP=1, COUNT=4), "an array in equal steps"),
    ],
)
def test_an_array_from_which_no_shard_follows_is_refused(variables: dict[str, str], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        shard_of("slurm", variables)


@pytest.mark.parametrize("text", ["0/4", "5/4", "1/0", "4", "a/b", "1/2/3", "-1/4", "1.5/4"])
def test_what_is_no_shard_is_refused_with_the_rule(text: str) -> None:
    with pytest.raises(ConfigError, match=r"shard must be i/n with i from 1 to n, for instance 1/4, or slurm or null"):
        compose([f"shard={text}"])


def test_it_is_no_part_of_the_identity_of_a_run(tmp_path: Path) -> None:
    tokens = ["launcher=serial", f"output={tmp_path}", "run=x", "episodes=4"]
    whole, half = (make_plan(expand([*tokens, *more])) for more in ([], ["shard=2/2"]))
    assert whole.cells[0].fingerprint == half.cells[0].fingerprint
    assert (list(whole.units), list(half.units)) == ([(0, 0), (0, 1), (0, 2), (0, 3)], [(0, 1), (0, 3)])
    assert half.folder == tmp_path / "run" / "x" / "parts" / "2-of-2"


@pytest.mark.parametrize(
    ("tokens", "said"),
    [
        (["shard=1/2"], "shards of one run need one name, by which they are joined: add run=<name>"),
        (["shard=1/2", "run=x", "memory=online"], "memory=online learns from one episode to the next"),
        (["shard=1/2,2/2", "run=x"], "shard takes one value, since each process drives one"),
    ],
)
def test_what_no_shard_can_drive_is_refused(tokens: list[str], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        make_plan(expand(["launcher=serial", *tokens]))


def test_commands_that_learn_in_order_or_drive_nothing_say_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ConfigError, match="driven in order, by one process; leave shard out"):
        make_plan(build_points(["interactions=2", "run=x", "shard=1/2", "launcher=serial"]))
    with pytest.raises(ConfigError, match="shards of one run need one name"):
        run_learn(["scenario=merge", "cda=full", "shard=1/2", "launcher=serial"])
    with pytest.raises(ConfigError, match="codriving bound has no shards; give each process seeds of its own"):
        run_bound(["shard=1/2", "run=x"], BoundOptions())
    with pytest.raises(ConfigError, match="a shard has no tables that could be given back"):
        codriving.run("shard=1/2", "run=x", "launcher=serial")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "token", ["llm.api_key=abcdefgh", "llm.headers={X-Auth:abc}", "llm.api_base=http://me:pw@host", "++llm.extra={a:1}"]
)
def test_what_may_be_a_secret_is_never_kept_in_a_part(token: str) -> None:
    with pytest.raises(ConfigError, match="may hold a secret, and a part keeps the command"):
        refuse_part((), ["scenario=merge", token])


def test_names_of_variables_and_limits_are_no_secrets() -> None:
    refuse_part((), ["llm.api_key_env=MY_KEY", "llm.max_tokens=500", "llm.max_tokens_field=max_completion_tokens"])


def test_a_secret_is_refused_before_anything_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    tokens = ["llm=openai", "llm.model=m", "llm.extra={user: me}", "shard=1/2", "run=x", "launcher=serial"]
    with pytest.raises(ConfigError, match=r"llm\.extra may hold a secret"):
        run_experiment(tokens)
    # Before it learns, which may cost money.
    with pytest.raises(ConfigError, match=r"llm\.extra may hold a secret"):
        run_learn([*tokens, "scenario=intersection", "cda=full", "interactions=1"])
    assert list(tmp_path.iterdir()) == []
