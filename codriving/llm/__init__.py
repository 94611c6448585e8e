"""Questions to a language model and its answers: prompts, requests, retries, limits, costs and parsing."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from codriving.llm.embeddings import EmbeddingModel
    from codriving.llm.ledger import Ledger
    from codriving.llm.prompts.free_text import Names, names_for, one_line, seen_names
    from codriving.llm.prompts.judging import ContestView, JudgementReply, chances, judgement_reply
    from codriving.llm.prompts.render import Prompts, load_prompts, prompts_name, template_files
    from codriving.llm.prompts.replies import (
        CorrectionReply,
        DecisionReply,
        LessonReply,
        OrderReply,
        correction_reply,
        decision_reply,
        first_of_pairs,
        order_reply,
        pair_names,
    )
    from codriving.llm.prompts.variables import decision_view, lane_views, memory_lines, negotiation_view
    from codriving.llm.prompts.views import MeaningView, SeenView, WayView
    from codriving.llm.question import Answer, Chat, Question
    from codriving.llm.scripted import ScriptedChat
    from codriving.llm.sqlite_file import connect_sqlite, create_sqlite

__all__ = [
    "Answer", "Chat", "ContestView", "CorrectionReply", "DecisionReply", "EmbeddingModel", "JudgementReply", "Ledger",
    "LessonReply", "MeaningView", "Names", "OrderReply", "Prompts", "Question", "ScriptedChat", "SeenView", "WayView",
    "chances", "connect_sqlite", "correction_reply", "create_sqlite", "decision_reply", "decision_view",
    "first_of_pairs", "judgement_reply", "lane_views", "load_prompts", "memory_lines", "names_for", "negotiation_view",
    "one_line", "order_reply", "pair_names", "prompts_name", "seen_names", "template_files",
]  # fmt: skip


_FILES = {
    "embeddings": ("EmbeddingModel",),
    "ledger": ("Ledger",),
    "prompts.free_text": ("Names", "names_for", "one_line", "seen_names"),
    "prompts.judging": ("ContestView", "JudgementReply", "chances", "judgement_reply"),
    "prompts.render": ("Prompts", "load_prompts", "prompts_name", "template_files"),
    "prompts.replies": (
        "CorrectionReply", "DecisionReply", "LessonReply", "OrderReply", "correction_reply", "decision_reply",
        "first_of_pairs", "order_reply", "pair_names",
    ),
    "prompts.variables": ("decision_view", "lane_views", "memory_lines", "negotiation_view"),
    "prompts.views": ("MeaningView", "SeenView", "WayView"),
    "question": ("Answer", "Chat", "Question"),
    "scripted": ("ScriptedChat",),
    "sqlite_file": ("connect_sqlite", "create_sqlite"),
}  # fmt: skip


def __getattr__(name: str) -> object:
    """Import a file with the first use of a name in it: where rules reason, no prompt and no reply is needed."""
    for file, names in _FILES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{file}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
