"""One party of a negotiation: what it answers, what it proposes if it coordinates, and which agreements it holds."""

from collections.abc import Mapping, Sequence
from math import hypot, inf
from typing import NamedTuple

from codriving.datatypes import (
    EACH,
    NEAREST,
    Coordination,
    OrderAgreement,
    OrderMessage,
    Pair,
    Party,
    Precedence,
    Proposal,
    Response,
)
from codriving.protocol.proposals import Proposals
from codriving.protocol.refusal import fixed, refused, with_given, without_circles
from codriving.reasoning import Coordinator, Moment, Problem


class _Promise(NamedTuple):
    number: tuple[int, int]  # Of the proposal, and its round
    time: float  # When it was accepted [s]
    until: float  # [s]
    reason: str


class Negotiator(Party):
    """A CAV, or a unit that only coordinates.

    A CAV that has accepted to be second is second from then on, and one that is to be first is so only when it has
    heard of the agreement; so a lost agreement does not make both of a pair go first. A promise ends with an agreement
    of its proposer about the pair, or after twice the validity: a CAV that no renewed agreement has reached for so
    long decides by itself.

    Between two decisions it answers at once, by what it knew at the last one.
    """

    def __init__(self, coordination: Coordination, coordinator: Coordinator) -> None:
        self.settings = coordination
        self._proposals = Proposals(coordination, coordinator, coordination.by == EACH, self._answer_to)
        self._problem: Problem | None = None
        self._held: dict[str, OrderAgreement] = {}
        # What it has accepted: that others go first, since when and until when [s], by who proposed it and number.
        self._promised: dict[tuple[str, Pair], _Promise] = {}
        self._out: list[OrderMessage] = []
        self._heard: dict[str, float] = {}  # When each CAV that coordinates was heard last, itself included [s]

    @property
    def coordinator(self) -> Coordinator:
        """What is asked who goes first, if this party proposes."""
        return self._proposals.coordinator

    @coordinator.setter
    def coordinator(self, coordinator: Coordinator) -> None:
        self._proposals.coordinator = coordinator

    @property
    def held(self) -> Mapping[str, OrderAgreement]:
        return self._held

    def hear(self, messages: Sequence[OrderMessage], time: float) -> None:
        """Take in what has arrived, and answer it by what was known at the last decision."""
        me = self.settings.party
        for message in messages:
            if isinstance(message, Response):
                if message.to == me:
                    self._say(self._proposals.hear(message, time))
                continue
            self._heard[message.sender] = time
            if isinstance(message, Proposal) and me in message.to and self._problem is not None:
                if time <= message.time + message.validity:
                    self._out.append(self._answer_to(message, time))
            elif isinstance(message, OrderAgreement):
                self._hold(message)

    def speak(self) -> list[OrderMessage]:
        """Return what it wants to send since it was asked last."""
        said, self._out = self._out, []
        return said

    def step(self, moment: Moment, problem: Problem) -> dict[Pair, str]:
        """Return the pairs that are agreed on, with the reasons, and propose what is new if this one coordinates."""
        self._problem = problem
        self._held = {sender: a for sender, a in self._held.items() if a.holds(moment.time)}
        self._promised = {key: promise for key, promise in self._promised.items() if moment.time < promise.until}
        for (sender, pair), promise in self._promised.items():
            self._withdraw(sender, promise.number, [pair], problem, moment.time)
        for agreement in self._held.values():
            if not agreement.authority:
                pairs = [(p.first, p.second) for p in agreement.pairs]
                self._withdraw(agreement.sender, (agreement.number, agreement.round), pairs, problem, moment.time)
        if self._coordinates(moment, problem):
            self._heard[self.settings.party] = moment.time
            self._say(self._proposals.step(moment, problem))
        return self.agreed(moment.time)

    def agreed_problem(self, moment: Moment, problem: Problem) -> Problem:
        """Do so for one that orders all CAVs by a rule: return a problem in which what is agreed on is fixed."""
        self.step(moment, problem)
        return self.with_agreed(problem, moment.time)

    def with_agreed(self, problem: Problem, time: float) -> Problem:
        """Return a problem in which what is agreed on is fixed."""
        agreed, there = self.agreed(time), problem.instance.vehicles.keys()
        given = {pair: why for pair, why in agreed.items() if there >= set(pair)}
        return with_given(problem, without_circles(given, problem.instance, min))

    def agreed(self, time: float) -> dict[Pair, str]:
        """Return the pairs of all agreements in force, those of a newer one in the place of an older one's."""
        found: dict[frozenset[str], tuple[float, Pair, str]] = {}
        for agreement in sorted((a for a in self._held.values() if a.holds(time)), key=lambda a: (a.time, a.sender)):
            told = f"directed by {agreement.sender}, {agreement.authority}"
            how = told if agreement.authority else f"agreed with {agreement.sender}"
            for p in agreement.pairs:
                pair = p.first, p.second
                found[frozenset(pair)] = agreement.time, pair, f"{how}: {p.reason}"
        for (sender, pair), promise in sorted(self._promised.items(), key=lambda known: (known[1].time, known[0])):
            since = found.get(frozenset(pair), (-inf,))[0]
            if since <= promise.time and time < promise.until:
                found[frozenset(pair)] = promise.time, pair, f"promised to {sender}: {promise.reason}"
        return {pair: why for _, pair, why in found.values()}

    def directed(self, ego: str) -> bool:
        """Whether a CAV goes by an instruction."""
        return any(a.authority and any(ego in (p.first, p.second) for p in a.pairs) for a in self._held.values())

    def _say(self, messages: list[OrderMessage]) -> None:
        self._out += messages
        for message in messages:
            if isinstance(message, OrderAgreement):
                self._hold(message)

    def _hold(self, agreement: OrderAgreement) -> None:
        known = self._held.get(agreement.sender)
        if known is None or known.time < agreement.time:
            self._held[agreement.sender] = agreement
            settled = {frozenset((p.first, p.second)) for p in agreement.pairs}
            self._promised = {
                key: promise
                for key, promise in self._promised.items()
                if key[0] != agreement.sender
                or promise.number > (agreement.number, agreement.round)
                or frozenset(key[1]) not in settled
            }

    def _answer_to(self, proposal: Proposal, time: float | None = None) -> Response:
        """Accept a proposal, or say what has to be instead."""
        me, problem = self.settings.party, self._problem
        pairs = refused(proposal, me, problem) if problem is not None else []
        mine = self._proposals.current
        if self.settings.by == EACH and mine is not None and me < proposal.sender:
            why = f"{me} has proposed otherwise, and of two proposals that of the smaller name counts"
            ours = {(p.second, p.first) for p in mine.pairs} - {(p.second, p.first) for p in pairs}
            pairs += [Precedence(p.second, p.first, why) for p in proposal.pairs if (p.first, p.second) in ours]
        now = proposal.time if time is None else time
        rejected = {frozenset((p.first, p.second)) for p in pairs}
        for p in proposal.pairs:
            if p.second == me and frozenset((p.first, p.second)) not in rejected:
                about, until = (proposal.number, proposal.round), now + 2 * proposal.validity
                self._promised[proposal.sender, (p.first, p.second)] = _Promise(about, now, until, p.reason)
        return Response(me, now, proposal.number, proposal.round, tuple(pairs), proposal.sender, not pairs)

    def _withdraw(
        self, sender: str, number: tuple[int, int], pairs: Sequence[Pair], problem: Problem, now: float
    ) -> None:
        """Tell the one that coordinates what cannot be kept any more."""
        me = self.settings.party
        turned = [(second, first) for first, second in pairs if me in (first, second)]
        instead = tuple(Precedence(*pair, why) for pair in turned if (why := fixed(problem.instance, *pair)))
        if instead and sender != me:
            self._out.append(Response(me, now, *number, instead, sender, False))

    def _coordinates(self, moment: Moment, problem: Problem) -> bool:
        """Whether this party is the one that coordinates.

        If a CAV does: the one that has been heard to, of several the smallest name; if none has, the one that is
        nearest to the middle of the junction of those that still have a conflict ahead.
        """
        settings, there = self.settings, problem.instance.vehicles.keys()
        if settings.by != NEAREST:
            return settings.by in (EACH, settings.party)
        since = moment.time - settings.validity
        heard = [name for name, time in self._heard.items() if time >= since and name in there]
        return settings.party == (
            min(heard) if heard else min(there, key=lambda name: _far(moment, name, settings), default="")
        )


def _far(moment: Moment, name: str, settings: Coordination) -> tuple[float, str]:
    """Return how far a CAV is from the middle of the junction [m], and its name."""
    ego, (x, y) = moment.scenes[name].ego, settings.centre
    return hypot(ego.x - x, ego.y - y), name
