"""One question until it is answered or given up: shorter if it is too long, and asked again once."""

from collections.abc import Awaitable, Callable

from codriving.llm.parsing import judge, one_line
from codriving.llm.question import Answer, Call, Message, Question
from codriving.llm.request import TOO_LONG, Reply, schema_of, worded

Fetch = Callable[[tuple[Message, ...], Question], Awaitable[tuple[Reply, bool]]]
"""Gives the reply to a conversation, and whether it came from the cache."""


async def converse(question: Question, fetch: Fetch) -> Answer:
    """Ask a question."""
    calls: list[Call] = []
    shortened = 0
    again: tuple[Message, ...] = ()
    while True:
        messages = question.messages + again
        reply, cached = await fetch(messages, question)
        value, problem = judge(reply, question)
        call = Call(
            messages=worded(messages, reply.form, schema_of(question.schema)),
            text=reply.text,
            form=reply.form,
            prompt_tokens=reply.prompt_tokens,
            completion_tokens=reply.completion_tokens,
            cost=reply.cost,
            seconds=reply.seconds,
            attempts=reply.attempts,
            cached=cached,
            problem=problem,
        )
        calls.append(call)
        if reply.finish_reason == TOO_LONG:
            shorter = question.shorter()
            if shorter is None:
                return Answer(None, tuple(calls), problem, shortened)
            question, shortened = shorter, shortened + 1
        elif value is not None or again:
            return Answer(value, tuple(calls), problem, shortened)
        else:
            # Some servers insist that user and assistant take turns.
            wish = f"This answer cannot be used: {problem}. Answer again, with one JSON object of the form asked for."
            again = (Message("assistant", one_line(reply.text, 2000) or "(no answer)"), Message("user", wish))
