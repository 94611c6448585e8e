"""What a model is told of a memory: its text, how alike it is, how often it was, and how often its action went well."""

from remembered import memory

from codriving.datatypes.experience import Verdict
from codriving.datatypes.world import Action
from codriving.llm.prompts.free_text import Names
from codriving.llm.prompts.variables import memory_lines

EASED, INTENSIFIED = Verdict.EASED, Verdict.INTENSIFIED


def test_one_that_was_made_once_says_how_alike_it_is() -> None:
    [line] = memory_lines([memory(similarity=0.956)], Names([]))
    assert line.endswith(" similar actions should be avoided. (96% alike, once)")


def test_how_often_an_action_went_well_counts_all_that_are_told() -> None:
    told = [
        memory(Action.FASTER, INTENSIFIED, 0.99, count=3),
        memory(Action.SLOWER, EASED, 0.98),
        memory(Action.FASTER, EASED, 0.97, count=4),
        memory(Action.FASTER, Verdict.TOO_CAUTIOUS, 0.96),
    ]
    endings = [line[line.rindex("(") :] for line in memory_lines(told, Names([]))]
    assert endings == [
        "(99% alike, 3 times; FASTER went well in 4 of 8 like cases)",
        "(98% alike, once)",
        "(97% alike, 4 times; FASTER went well in 4 of 8 like cases)",
        "(96% alike, once; FASTER went well in 4 of 8 like cases)",
    ]
