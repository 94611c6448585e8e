"""Methods: every row of a table is a pipeline with other objects in its slots."""

from codriving.methods.language_model.model_decider import CheckedDecider
from codriving.methods.language_model.prompted_model import prompted
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
from codriving.methods.ppo import Ppo
from codriving.methods.single_vehicle.method import Driver, SingleVehicle
from codriving.methods.tell import Tell

__all__ = [
    "ACTIONS", "ATTENTION", "EGO", "FAMILIES", "FAR", "FORMS", "HEADS", "NEAR", "PERCEPTRON", "SLOT", "SLOTS",
    "VERSION", "WIDTH", "AnyNetwork", "Attention", "CheckedDecider", "Driver", "Features", "FloatArray", "Madqn",
    "Network", "Observation", "Ppo", "Purpose", "SingleVehicle", "Tell", "Trained", "allowed", "feature_count",
    "greedy", "load", "prompted", "save",
]  # fmt: skip
