"""Who has proposed an order, who has accepted it, and who holds what was agreed on, in words."""

from collections.abc import Mapping, Sequence
from typing import Any

from codriving.datatypes import UNITS

MOST = 3  # Proposals that are shown at once


class Talk:
    """What has been said, line after line of ``decisions.jsonl``."""

    def __init__(self) -> None:
        self._asked: dict[str, tuple[Any, Any, set[str]]] = {}
        self._answers: dict[str, dict[str, str]] = {}

    def after(self, line: Mapping[str, Any]) -> tuple[str, ...]:
        """Return what is to be seen from a decision on; nothing where no orders are sent."""
        said = line.get("said")
        if not isinstance(said, Sequence) or isinstance(said, str):
            return ()
        for message in said:
            if isinstance(message, Mapping):
                self._take_in(message)
        cavs = [entry for entry in line.get("cavs", ()) if isinstance(entry, Mapping)]
        there = {str(entry.get("id")) for entry in cavs}
        # A CAV that has left proposes no more.
        speaking = [sender for sender in sorted(self._asked) if sender in there or sender in UNITS]
        words = [text for sender in speaking if (text := self._proposed(sender, there))][:MOST]
        return (*words, *_held(cavs))

    def _take_in(self, message: Mapping[str, Any]) -> None:
        sender, number = str(message.get("sender")), (message.get("number"), message.get("round"))
        kind, pairs = message.get("kind"), message.get("pairs") or ()
        to = [str(name) for name in message.get("arrives") or ()]
        if kind == "proposal":
            if self._asked.get(sender, (None, None))[:2] != number:
                self._asked[sender], self._answers[sender] = (*number, set()), {}
            self._asked[sender][2].update(to)
        elif kind in ("acceptance", "rejection") and to and self._asked.get(to[0], (None, None))[:2] == number:
            why = str(pairs[0][2]) if pairs and len(pairs[0]) > 2 else ""
            self._answers[to[0]][sender] = why or ("" if kind == "acceptance" else "no reason")

    def _proposed(self, sender: str, there: set[str]) -> str:
        number, number_of_round, asked = self._asked[sender]
        if not asked & there:
            return ""
        answers = {name: why for name, why in sorted(self._answers[sender].items()) if name in there}
        accept = [name for name, why in answers.items() if not why]
        silent = sorted((asked & there) - answers.keys())
        parts = [f"{', '.join(accept)} accept{'s' * (len(accept) == 1)}"] if accept else []
        parts += [f"{name} rejects: {why}" for name, why in answers.items() if why]
        parts += [f"no answer of {', '.join(silent)}"] if silent else []
        return f"{sender} proposes ({number}, round {number_of_round}): {'; '.join(parts)}"


def _held(cavs: Sequence[Mapping[str, Any]]) -> list[str]:
    """Say whose agreements and instructions are held by whom."""
    holders: dict[tuple[str, str], list[str]] = {}
    for entry in cavs:
        for held in entry.get("agreements") or ():
            if isinstance(held, Mapping):
                key = (str(held.get("sender")), str(held.get("authority") or ""))
                holders.setdefault(key, []).append(str(entry.get("id")))
    return [
        f"{sender}, {authority}, directs {', '.join(names)}"
        if authority
        else f"agreement of {sender}, held by {', '.join(names)}"
        for (sender, authority), names in sorted(holders.items())
    ]
