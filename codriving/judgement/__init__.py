"""Whether human drivers let a CAV pass: a question that rules, a fitted model or a language model can answer."""

from codriving.judgement.asked_model import AskedModel
from codriving.judgement.contests import Contest, contests
from codriving.judgement.going_on import entered, lets_pass
from codriving.judgement.hindsight import let_pass, look_back
from codriving.judgement.judge import Judge, Judging, is_valid, judgements_of

__all__ = [
    "AskedModel",
    "Contest",
    "Judge",
    "Judging",
    "contests",
    "entered",
    "is_valid",
    "judgements_of",
    "let_pass",
    "lets_pass",
    "look_back",
]
