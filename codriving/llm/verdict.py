"""What a reply is worth: an answer that can be used, or what was wrong with it in words that the model is told."""

from pydantic import BaseModel, ValidationError

from codriving.llm.extract import is_page, last_object, one_line
from codriving.llm.question import Question
from codriving.llm.reply import TOO_LONG, UNREADABLE, Reply

_LONGEST = 500
_CUT_OFF = ("length", "max_tokens")
_FILTERED = ("content_filter", "safety", "refusal")


def judge(reply: Reply, question: Question) -> tuple[BaseModel | None, str]:
    """Read an answer out of a reply.

    Returns:
        The answer and an empty text, or None and what is wrong with the reply.
    """
    problem = _unusable(reply)
    if problem:
        return None, problem
    found = last_object(reply.text)
    if found is None:
        return None, "the answer holds no complete JSON object"
    try:
        value = question.schema.model_validate(found)
    except ValidationError as err:
        return None, one_line(f"the JSON does not fit: {_listed(err)}", _LONGEST)
    except RecursionError:
        return None, "the JSON is nested too deeply"
    wrong = question.check(value)
    return (None, one_line(wrong, _LONGEST)) if wrong else (value, "")


def _unusable(reply: Reply) -> str:
    """Say why a reply cannot hold an answer; empty if it can."""
    if reply.finish_reason == TOO_LONG:
        return "the question is longer than the model's context"
    if reply.finish_reason == UNREADABLE or is_page(reply.text):
        return "the reply is no chat completion (a web page, or broken JSON)"
    if reply.refusal:
        return one_line(f"the model refused: {reply.refusal}", _LONGEST)
    if reply.finish_reason.lower() in _FILTERED:
        return "the answer was withheld by a content filter"
    if reply.finish_reason.lower() in _CUT_OFF:
        return "the answer was cut off at the token limit; keep it shorter"
    return "" if reply.text.strip() else "the answer is empty"


def _listed(error: ValidationError) -> str:
    parts = []
    for one in error.errors(include_url=False, include_context=False):
        where = ".".join(str(part) for part in one["loc"])
        parts.append(f"{where}: {one['msg']}" if where else one["msg"])
    return "; ".join(parts)
