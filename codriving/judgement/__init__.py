"""Whether human drivers let a CAV pass: a question that rules, a fitted model or a language model can answer."""

from codriving.judgement.hindsight import look_back
from codriving.judgement.judge import Judging, judgements_of

__all__ = ["Judging", "judgements_of", "look_back"]
