"""Trained weights in a file, and beside it what they were trained for; they are refused for anything else."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any, Self

import numpy as np
from safetensors import SafetensorError
from safetensors.numpy import load_file
from safetensors.numpy import save as packed

from codriving.errors import WeightsError
from codriving.methods.learned.layout import ACTIONS, FAMILIES, FAR, NEAR, VERSION, feature_count
from codriving.methods.learned.network import FORMS, PERCEPTRON, AnyNetwork, network_of, shapes, tensors

# That in which weights were trained whose file does not say it: there was no other one.
FIRST_WORLD: Mapping[str, str] = {"limits": "none", "drivers": "simulator"}

CLOSE = 1e-6  # Numbers of a road and of the weights that differ by less are the same


@dataclass(frozen=True, slots=True)
class Purpose:
    """What weights were trained for."""

    method: str  # Name of the learner, for instance ``madqn``
    family: str  # ``junction`` or ``lanes``
    features: int
    near: float  # Unit of length of gaps and zones, as a time at the highest target speed [s]
    far: float  # Unit of length along the own route, likewise [s]
    decision_interval: float  # Time between two decisions [s]
    target_speeds: tuple[tuple[float, ...], ...]  # The grids of target speeds that were driven with [m/s]
    actions: tuple[str, ...]
    hidden: tuple[int, ...]
    training: Mapping[str, Any]
    form: str = PERCEPTRON  # Kind of the network, ``perceptron`` or ``attention``
    world: Mapping[str, str] = field(default_factory=lambda: dict(FIRST_WORLD))  # ``limits`` and ``drivers``

    @classmethod
    def read(cls, text: str, where: str) -> Self:
        """Read the text of a sidecar.

        Raises:
            WeightsError: If it is not one.
        """
        try:
            found = json.loads(text)
            values = {field.name: found[field.name] for field in fields(cls) if field.name not in ("form", "world")}
            values["form"] = found.get("form", PERCEPTRON)
            values["world"] = {group: str(found.get("world", FIRST_WORLD)[group]) for group in FIRST_WORLD}
            values["target_speeds"] = tuple(tuple(map(float, grid)) for grid in values["target_speeds"])
            values["actions"], values["hidden"] = tuple(values["actions"]), tuple(map(int, values["hidden"]))
            made = cls(**values)
        except (ValueError, TypeError, KeyError, OverflowError, RecursionError) as err:
            raise WeightsError(f"{where} does not describe trained weights ({type(err).__name__}: {err})") from err
        if made.form not in FORMS:
            raise WeightsError(f"{where} is for a network of the kind {made.form!r}; known: {', '.join(FORMS)}")
        if made.family not in FAMILIES:
            raise WeightsError(f"{where} is for roads of the family {made.family!r}; known: {', '.join(FAMILIES)}")
        if (made.features, made.near, made.far) != (VERSION, NEAR, FAR):
            raise WeightsError(
                f"{where} needs features of version {made.features} (lengths {made.near:g} and {made.far:g} s), but "
                f"this is version {VERSION} ({NEAR:g} and {FAR:g} s); train again with codriving train {made.method}"
            )
        if made.actions != tuple(map(str, ACTIONS[made.family])):
            raise WeightsError(f"{where} has other actions than the family {made.family}: {', '.join(made.actions)}")
        return made

    def check(self, family: str, target_speeds: Sequence[float], decision_interval: float) -> None:
        """Refuse a road for which the weights were not trained.

        Features are in units of the highest target speed, so another grid will do if its highest speed and its step lie
        within those of the grids that were driven with.

        Args:
            target_speeds: Target speeds of its CAVs [m/s].
            decision_interval: Time between two decisions [s].

        Raises:
            WeightsError: If something does not fit.
        """
        if family != self.family:
            raise WeightsError(f"weights for the family {self.family} were given, but this road is one of {family}")
        if not math.isclose(decision_interval, self.decision_interval, abs_tol=CLOSE):
            raise WeightsError(
                f"{self.method} was trained on decisions every {self.decision_interval:g} s, but the scenario decides "
                f"every {decision_interval:g} s; set scenario.decision_frequency={1 / self.decision_interval:g}"
            )
        grids = [target_speeds, *self.target_speeds]
        tops, steps = [grid[-1] for grid in grids], [grid[1] - grid[0] for grid in grids]
        for name, (value, *known) in (("highest target speed", tops), ("step of target speeds", steps)):
            if not min(known) - CLOSE <= value <= max(known) + CLOSE:
                span = f"{min(known):g}" if min(known) == max(known) else f"{min(known):g} to {max(known):g}"
                raise WeightsError(
                    f"{self.method} was trained with a {name} of {span} m/s on roads of the family {self.family}, "
                    f"the scenario has {value:g} m/s; set scenario.target_speeds, or train on it: docs/train.md"
                )


@dataclass(frozen=True, slots=True)
class Trained:
    """A network and what it is for."""

    network: AnyNetwork
    purpose: Purpose


def shipped(method: str, family: str, limited: bool) -> Path:
    """Return the file of the weights that come with the package, for vehicles with limits or for those of the paper."""
    return Path(__file__).parent / "weights" / ("default" if limited else "paper") / f"{method}_{family}.safetensors"


def sidecar(file: Path) -> Path:
    """Return the file that says what weights are for."""
    return file.with_suffix(".json")


def save(file: Path, trained: Trained) -> None:
    """Write weights and their sidecar."""
    arrays = {name: np.ascontiguousarray(tensor) for name, tensor in tensors(trained.network).items()}
    # Not by the library's own file, which only its owner may read.
    file.write_bytes(packed(arrays))
    sidecar(file).write_text(json.dumps(asdict(trained.purpose), indent=2) + "\n", encoding="utf-8", newline="\n")


def load(file: Path) -> Trained:
    """Read weights and their sidecar.

    Raises:
        WeightsError: If one of them is missing, damaged, or of other shapes or features than are used here.
    """
    try:
        purpose = Purpose.read(sidecar(file).read_text(encoding="utf-8"), str(sidecar(file)))
        held = load_file(file)
    except OSError as err:
        raise WeightsError(f"cannot read {err.filename or file}: {err.strerror or err}") from err
    except (SafetensorError, UnicodeDecodeError) as err:
        raise WeightsError(f"{file} or the JSON beside it is damaged ({err})") from err
    wanted = shapes(purpose.form, feature_count(purpose.family), purpose.hidden, len(purpose.actions))
    found = {name: tensor.shape for name, tensor in held.items()}
    if found != wanted:
        wrong = sorted(name for name in {*found, *wanted} if found.get(name) != wanted.get(name))
        shown = ", ".join(f"{name} is {found.get(name)} and should be {wanted.get(name)}" for name in wrong)
        raise WeightsError(f"{file} does not hold the layers that its JSON describes: {shown}")
    if any(t.dtype != np.float32 or not np.isfinite(t).all() for t in held.values()):
        raise WeightsError(f"{file} must hold finite numbers of 32 bits; it is damaged or of another program")
    return Trained(network_of(purpose.form, held), purpose)
