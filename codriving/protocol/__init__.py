"""Classes C and D of SAE J3216 as messages: proposals, answers, agreements and instructions about who goes first."""

from codriving.protocol.by_messages import ByMessages
from codriving.protocol.negotiator import Negotiator
from codriving.protocol.refusal import with_given, without_circles

__all__ = ["ByMessages", "Negotiator", "with_given", "without_circles"]
