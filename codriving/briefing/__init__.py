"""What a language model is told and asked beyond a situation: outlook, what there is to judge, and what was decided."""

from codriving.briefing.briefing import Briefing
from codriving.briefing.judging import nothing_to_judge
from codriving.briefing.past import PastDecisions

__all__ = ["Briefing", "PastDecisions", "nothing_to_judge"]
