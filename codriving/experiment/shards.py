"""``shard=i/n``: which share of a run this process drives, and what the array of a scheduler says of it."""

from collections.abc import Mapping, Sequence
from typing import Any

from codriving.config import looks_secret
from codriving.errors import ConfigError
from codriving.experiment.cells import Cell
from codriving.experiment.remembering import learns
from codriving.runs import Shard, redact

SHARD, SLURM = "shard", "slurm"

_ARRAY = "SLURM_ARRAY_TASK_"
_FIELDS = ("llm.headers", "llm.extra")  # Where a key may stand under any name
_CURE = "submit the job with sbatch --array=1-4, or write shard=1/4"


def shard_of(text: str | None, variables: Mapping[str, str]) -> Shard | None:
    """Read the shard of a config.

    Args:
        text: ``i/n``, ``slurm``, or None.
        variables: Those of the environment, in which Slurm says which task of an array this is.
    """
    if text != SLURM:
        return Shard(*map(int, text.split("/"))) if text else None
    found = {}
    for name in ("ID", "MIN", "STEP", "COUNT"):
        value = variables.get(f"{_ARRAY}{name}")
        if value is None:
            raise ConfigError(f"shard=slurm needs a job array of Slurm, and {_ARRAY}{name} is not set; {_CURE}")
        if not (value.isascii() and value.isdecimal()):
            raise ConfigError(f"shard=slurm: {_ARRAY}{name} must be a whole number, got {value!r:.100}; {_CURE}")
        found[name] = int(value)
    place, rest = divmod(found["ID"] - found["MIN"], max(found["STEP"], 1))
    last = variables.get(f"{_ARRAY}MAX", "")
    steps = (int(last) - found["MIN"]) / max(found["STEP"], 1) if last.isascii() and last.isdecimal() else None
    if rest or not 0 <= place < found["COUNT"] or steps not in (None, found["COUNT"] - 1):
        raise ConfigError("shard=slurm needs an array in equal steps, from which each task knows its place; " + _CURE)
    if found["COUNT"] == 1:
        raise ConfigError(
            "shard=slurm in an array of one task would drive the whole run; to repeat a task of a larger array, say "
            "which shard it was, for instance shard=2/4"
        )
    return Shard(place + 1, found["COUNT"])


def check_shard(shard: Shard | None, run: str | None, configs: Sequence[Mapping[str, Any]]) -> None:
    """Refuse what no shard can drive."""
    if shard is None:
        return
    refuse_nameless(run)
    if any(learns(config) for config in configs):
        raise ConfigError(
            "memory=online learns from one episode to the next, so that these are driven in order, by one process; "
            "leave shard out, or recall what was learnt with memory=frozen"
        )


def refuse_nameless(run: str | None) -> None:
    """Refuse shards that nothing would bring together."""
    if run is None:
        raise ConfigError("shards of one run need one name, by which they are joined: add run=<name>")


def refuse_part(cells: Sequence[Cell], overrides: Sequence[str]) -> None:
    """Refuse what no part can go on with, and settings that may be secrets: it keeps the command that drives it."""
    if any(cell.repeatable is False for cell in cells):
        raise ConfigError(
            "with llm.latency=measured no shard could go on, for times cannot be measured again; leave shard out, or "
            "take another llm.latency"
        )
    for token in overrides:
        key, _, value = token.lstrip("+").partition("=")
        plain = redact({"llm": {key.rpartition(".")[2]: value}}) == {"llm": {key.rpartition(".")[2]: value}}
        if key.startswith(_FIELDS) or looks_secret(value) or not (plain or value.isdecimal()):
            raise ConfigError(
                f"{key} may hold a secret, and a part keeps the command that drives it; put it into a YAML of yours, "
                "below the folder of --config-dir, and leave it out here"
            )


def without_shard(overrides: Sequence[str]) -> list[str]:
    """Take ``shard=`` out of the tokens."""
    return [token for token in overrides if token.lstrip("+").partition("=")[0] != SHARD]
