"""Whether human drivers let a CAV pass: a question that rules, a fitted model or a language model can answer."""

from codriving.judgement.asked_model import AskedModel
from codriving.judgement.contests import Contest, contests
from codriving.judgement.hindsight import entries, let_pass, look_back
from codriving.judgement.judge import Judging, judgements_of

__all__ = ["AskedModel", "Contest", "Judging", "contests", "entries", "judgements_of", "let_pass", "look_back"]
