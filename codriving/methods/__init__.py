"""The methods, each a YAML and a row of the tables; and what several of them share."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from codriving.methods.codriving import CoDriving, perception_at
    from codriving.methods.language_model.model_coordinator import ModelCoordinator, most_urgent
    from codriving.methods.language_model.model_decider import CheckedDecider
    from codriving.methods.language_model.prompted_model import PromptedModel, prompted
    from codriving.methods.learned.features import Features, Observation
    from codriving.methods.learned.layout import (
        ACTIONS,
        EGO,
        FAMILIES,
        FAR,
        NEAR,
        SLOT,
        SLOTS,
        VERSION,
        allowed,
        feature_count,
    )
    from codriving.methods.learned.network import (
        ATTENTION,
        FORMS,
        HEADS,
        PERCEPTRON,
        WIDTH,
        AnyNetwork,
        Attention,
        FloatArray,
        Network,
        greedy,
    )
    from codriving.methods.learned.weights import Purpose, Trained, load, save
    from codriving.methods.madqn import Madqn
    from codriving.methods.ordered import Ordered
    from codriving.methods.ppo import Ppo
    from codriving.methods.single_vehicle.method import Driver, SingleVehicle
    from codriving.methods.tell import Tell

__all__ = [
    "ACTIONS", "ATTENTION", "EGO", "FAMILIES", "FAR", "FORMS", "HEADS", "NEAR", "PERCEPTRON", "SLOT", "SLOTS",
    "VERSION", "WIDTH", "AnyNetwork", "Attention", "CheckedDecider", "CoDriving", "Driver", "Features", "FloatArray",
    "Madqn", "ModelCoordinator", "Network", "Observation", "Ordered", "Ppo", "PromptedModel", "Purpose",
    "SingleVehicle", "Tell", "Trained", "allowed", "feature_count", "greedy", "load", "most_urgent", "perception_at",
    "prompted", "save",
]  # fmt: skip

_FILES = {
    "codriving": ("CoDriving", "perception_at"),
    "language_model.model_coordinator": ("ModelCoordinator", "most_urgent"),
    "language_model.model_decider": ("CheckedDecider",),
    "language_model.prompted_model": ("PromptedModel", "prompted"),
    "learned.features": ("Features", "Observation"),
    "learned.layout": (
        "ACTIONS", "EGO", "FAMILIES", "FAR", "NEAR", "SLOT", "SLOTS", "VERSION", "allowed", "feature_count",
    ),
    "learned.network": (
        "ATTENTION", "FORMS", "HEADS", "PERCEPTRON", "WIDTH", "AnyNetwork", "Attention", "FloatArray", "Network",
        "greedy",
    ),
    "learned.weights": ("Purpose", "Trained", "load", "save"),
    "madqn": ("Madqn",),
    "ordered": ("Ordered",),
    "ppo": ("Ppo",),
    "single_vehicle.method": ("Driver", "SingleVehicle"),
    "tell": ("Tell",),
}  # fmt: skip


def __getattr__(name: str) -> object:
    """Import a file with the first use of its name: a method does not wait for what the networks of others need."""
    for file, names in _FILES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{file}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
