"""Asks the questions of an exam, and reads the answers as they are read when a model drives."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any, cast

from codriving.datatypes import Action, Model
from codriving.errors import ModelError
from codriving.exam.stored import ExamNegotiation, ExamSituation, StoredExam
from codriving.geometry import RoadMap
from codriving.judgement import AskedModel
from codriving.llm import Answer, Chat, Ledger, Question, ScriptedChat, load_prompts
from codriving.methods import CheckedDecider, ModelCoordinator, PromptedModel, prompted
from codriving.reasoning import RuleDecider

Asked = ExamSituation | ExamNegotiation


@dataclass(frozen=True, slots=True)
class Answered:
    """What was made of one question of an exam."""

    asked: Asked
    action: Action | None = None  # None if there is no answer that can be used
    first: Mapping[tuple[str, str], str] = field(default_factory=dict)  # Who goes first of the pairs that were ordered
    yields: tuple[bool | None, ...] = ()  # Whether each driver was taken to let the CAV pass; None where that is open
    lines: tuple[Mapping[str, Any], ...] = ()  # As in ``transcript.jsonl``; none of who is not asked
    counts: Mapping[str, float] = field(default_factory=dict)

    @property
    def decided(self) -> object:
        """What was answered, to be compared with another time."""
        return self.action, sorted(self.first.items()), self.yields


def by_rules(asked: Asked) -> Answered:
    """Answer as the built-in rules do; orders as they did when the exam was built."""
    if isinstance(asked, ExamNegotiation):
        return Answered(asked, first={(pair.one, pair.other): pair.first for pair in asked.pairs})
    decision = RuleDecider().decide([asked.situation])[0]
    return Answered(asked, decision.action, yields=tuple(bool(contest.rule) for contest in asked.contests))


def by_model(asked: Asked, model: PromptedModel) -> Answered:
    """Ask a model, as codriving does when nothing has been decided before."""
    if isinstance(asked, ExamNegotiation):
        coordinator = ModelCoordinator(model, binding=False)
        coordinator.rules.previous = asked.previous
        agreed, _ = coordinator.ask(asked.scenes, asked.problem, asked.conflicts)
        first = {(p.one, p.other): pair[0] for pair in agreed or () if (p := asked.pair(pair)) is not None}
        counts, lines = model.ledger.close_step(asked.problem.instance.time)
        return Answered(asked, first=first, lines=tuple(lines), counts=counts)
    decision = CheckedDecider(model, ask_plain=True, sees_conflicts=True).decide([asked.situation])[0]
    yields: tuple[bool | None, ...] = ()
    if asked.contests:
        judge = AskedModel(0.5, 0.5)
        judge.reset(cast(RoadMap, None), model)  # Without a memory it looks at no road
        judged = judge.judge(asked.contests)
        both = [judged.get((contest.cav, contest.human)) for contest in asked.contests]
        yields = tuple(None if one is None or one.yields == 0.5 else one.yields > 0.5 for one in both)
    counts, lines = model.ledger.close_step(0.0)
    usable = any(line["purpose"] == "decide" and line["value"] is not None for line in lines)
    action = decision.action if usable else None
    return Answered(asked, action, yields=yields, lines=tuple(lines), counts=counts)


def sit(
    questions: Sequence[Asked], llm: Model, patience: int = 20, tell: Callable[[int], None] = lambda _: None
) -> list[Answered]:
    """Ask all questions, several at once where a model takes them.

    Args:
        patience: Questions without a usable answer at the beginning after which no more are asked.
        tell: Is told how many have been answered.

    Raises:
        ModelError: If the first questions have no usable answer, or the model cannot be asked.
    """
    if llm.chat() is None:
        return [by_rules(one) for one in questions]

    def ask(k: int) -> Answered:
        model = prompted(llm, k)
        assert model is not None
        return by_model(questions[k], model)

    found: list[Answered] = []
    pool = ThreadPoolExecutor(llm.max_concurrency)
    try:
        for answered in pool.map(ask, range(len(questions))):
            found.append(answered)
            tell(len(found))
            if len(found) == patience and not any(line["value"] for one in found for line in one.lines):
                raise ModelError(
                    f"{llm.name}: no usable answer to any of the first {patience} questions; see what codriving check "
                    "says"
                )
    finally:
        pool.shutdown(cancel_futures=True)
    return found


def some(exam: StoredExam, most: int | None) -> list[Asked]:
    """Return so many questions at most, evenly out of all; situations first."""
    questions: list[Asked] = [*exam.situations, *exam.negotiations]
    if most is None or most >= len(questions):
        return questions
    return [questions[k * len(questions) // most] for k in range(most)]


class _Collected(Chat):
    """Answers nothing, and keeps what is asked."""

    name = "collected"

    def __init__(self) -> None:
        self.questions: list[Question] = []

    def ask(self, questions: Sequence[Question]) -> list[Answer]:
        self.questions += questions
        return [Answer(None, (), "not asked") for _ in questions]


def wording(asked: Asked, prompts: str | None = None) -> list[Question]:
    """Return what a model is asked: an order, or a decision and, where drivers are to be judged, that."""
    chat = _Collected()
    by_model(asked, PromptedModel(chat, load_prompts(prompts), Ledger()))
    return chat.questions


def as_said(asked: Asked, said: Mapping[str, str], prompts: str | None = None) -> Answered:
    """Read the answers of one who was asked elsewhere, in its own words, by the purpose of each question."""
    chat = ScriptedChat(lambda question: said.get(question.purpose, ""))
    return by_model(asked, PromptedModel(chat, load_prompts(prompts), Ledger()))
