"""What one that coordinates puts forward, round after round, and what of it has been accepted."""

from collections.abc import Callable, Iterable
from dataclasses import replace

from codriving.datatypes import (
    Coordination,
    OrderAgreement,
    OrderMessage,
    Pair,
    Precedence,
    Proposal,
    Response,
)
from codriving.protocol.refusal import not_in, without_circles
from codriving.reasoning import Coordinator, Moment, Problem

Answer = Callable[[Proposal], Response]  # What the party itself says to its own proposal


class Proposals:
    """The negotiation that one party leads."""

    def __init__(self, coordination: Coordination, coordinator: Coordinator, only_own: bool, answer: Answer) -> None:
        self._coordination, self.coordinator, self._answer = coordination, coordinator, answer
        self._only_own = only_own  # Whether it proposes for its own conflicts alone
        self._number, self._begun = 0, 0.0
        self._current: Proposal | None = None
        self._answers: dict[str, Response] = {}
        # What CAVs have said that has to be, with the time until which it is believed [s].
        self._given: dict[Pair, tuple[str, float]] = {}

    @property
    def current(self) -> Proposal | None:
        """What is proposed now."""
        return self._current

    def step(self, moment: Moment, problem: Problem) -> list[OrderMessage]:
        """Return what is to be said at a decision: what is new, and again what has not been answered."""
        self._moment, self._problem, now = moment, problem, moment.time
        there = problem.instance.vehicles.keys()
        self._given = {p: known for p, known in self._given.items() if known[1] > now and there >= set(p)}
        if self._rejections() and (more := self._another_round(now)):
            return more
        pairs = self._pairs()
        if self._coordination.authority:
            return [self._agreement(pairs, now)] if pairs else []
        self._forget(pairs)
        current = self._current
        if not pairs:
            self._current = None
        elif current is None or not _named(pairs) <= _named(current.pairs):
            return self._begin(pairs, now)
        else:
            return self._repeat(current, now)
        return []

    def hear(self, response: Response, time: float) -> list[OrderMessage]:
        """Take in an answer; once all have answered, return the next round or the agreement."""
        current = self._current
        if current is None or (response.number, response.round) != (current.number, current.round):
            return []
        known = self._answers.get(response.sender)
        if known is not None:
            new = tuple(p for p in response.pairs if (p.first, p.second) not in _named(known.pairs))
            if not new:
                return []  # Said again, since it was asked again, or overtaken
            # What is withdrawn comes on top of what was rejected before.
            response = replace(known, pairs=known.pairs + new, accepted=False)
        self._answers[response.sender] = response
        if not _parties(current.pairs) <= self._answers.keys():
            return []
        if self._rejections() and (more := self._another_round(time)):
            return more
        return self._agreed(current, time)

    def _begin(self, pairs: tuple[Precedence, ...], now: float) -> list[OrderMessage]:
        self._number, self._begun = self._number + 1, now
        return self._propose(pairs, now, 1)

    def _propose(self, pairs: tuple[Precedence, ...], now: float, number_of_round: int) -> list[OrderMessage]:
        me = self._coordination.party
        humans = sorted({human for people in self._problem.passages.values() for human in people})
        to = tuple(sorted(_parties(pairs) - {me}))
        about = me, now, self._number, number_of_round, pairs
        self._current = Proposal(*about, to, tuple(humans), self._coordination.validity)
        self._answers = {me: self._answer(self._current)} if me in _parties(pairs) else {}
        return [self._current]

    def _repeat(self, current: Proposal, now: float) -> list[OrderMessage]:
        """Return what has not been answered once more, and what both have accepted."""
        missing = tuple(name for name in current.to if name not in self._answers)
        again: list[OrderMessage] = [replace(current, time=now, to=missing)] if missing else []
        return again + self._agreed(current, now)

    def _another_round(self, now: float) -> list[OrderMessage]:
        """Propose what those who rejected can do; nothing if there have been enough rounds for now."""
        current, settings = self._current, self._coordination
        if current is None:
            return []
        last = current.round >= settings.rounds
        if last and now <= self._begun + settings.validity:
            return []
        for p in self._rejections():
            self._given.pop((p.second, p.first), None)
            self._given[p.first, p.second] = p.reason, now + settings.validity
        pairs = self._pairs()
        if not pairs:
            return []
        return self._begin(pairs, now) if last else self._propose(pairs, now, current.round + 1)

    def _rejections(self) -> list[Precedence]:
        """Return what has to be instead of pairs that are proposed now."""
        proposed = _named(self._current.pairs) if self._current is not None else set()
        said = (p for _, answer in sorted(self._answers.items()) for p in answer.pairs)
        return [p for p in said if (p.second, p.first) in proposed]

    def _agreed(self, current: Proposal, now: float) -> list[OrderMessage]:
        kept = tuple(p for p in current.pairs if self._accepts(p.first, p) and self._accepts(p.second, p))
        return [self._agreement(kept, now)] if kept else []

    def _accepts(self, name: str, p: Precedence) -> bool:
        answer = self._answers.get(name)
        return answer is not None and (p.second, p.first) not in _named(answer.pairs)

    def _agreement(self, pairs: tuple[Precedence, ...], now: float) -> OrderAgreement:
        settings, current = self._coordination, self._current
        numbers = (self._number, 1) if current is None else (current.number, current.round)
        return OrderAgreement(settings.party, now, *numbers, pairs, settings.validity, settings.authority)

    def _forget(self, pairs: tuple[Precedence, ...]) -> None:
        """Leave pairs out of what is proposed that are no longer open, so that they need no answer any more."""
        if self._current is not None:
            left = tuple(p for p in self._current.pairs if {(p.first, p.second), (p.second, p.first)} & _named(pairs))
            to = tuple(name for name in self._current.to if name in _parties(left))
            self._current = replace(self._current, pairs=left, to=to)

    def _pairs(self) -> tuple[Precedence, ...]:
        """Return who goes first of each two CAVs, by what is known now and by what CAVs have said."""
        said = {pair: why for pair, (why, _) in self._given.items()}
        given = without_circles(self._emergency() | said, self._problem.instance, not_in(said))
        order = self.coordinator.negotiate(self._moment, given)
        cavs, me = self._moment.scenes.keys(), self._coordination.party
        pairs = (p for p in order.precedences if p.first in cavs and p.second in cavs)
        return tuple(p for p in pairs if not self._only_own or me in (p.first, p.second))

    def _emergency(self) -> dict[Pair, str]:
        """Let an emergency vehicle go first, and those that are ahead of it on its lane."""
        instance, urgent = self._problem.instance, self._coordination.emergency
        found: dict[Pair, str] = {}
        name, cleared = urgent if urgent in instance.vehicles else None, set[str]()
        while name is not None and name not in cleared:
            cleared.add(name)
            why = f"{urgent} is an emergency vehicle" if name == urgent else f"{name} is ahead of {urgent} in emergency"
            for other in sorted(instance.vehicles.keys() - cleared):
                if instance.conflict(name, other) and (other, name) not in instance.before:
                    found[name, other] = why
            name = instance.vehicles[name].leader
        return found


def _parties(pairs: Iterable[Precedence]) -> set[str]:
    return {name for p in pairs for name in (p.first, p.second)}


def _named(pairs: Iterable[Precedence]) -> set[Pair]:
    return {(p.first, p.second) for p in pairs}
