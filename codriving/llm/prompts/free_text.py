"""Names and sentences as they may stand in a prompt: on one line, capped, and without what an ablation hides."""

import re
import unicodedata
from collections.abc import Iterable, Mapping
from functools import lru_cache

from codriving.datatypes import SceneDescription, Situation

LONGEST_NAME = 32  # Characters of a vehicle's name

LONGEST_SENTENCE = 160  # Characters of a reason

LONGEST_MEMORY = 400  # Characters of a memory


def one_line(text: str, longest: int = LONGEST_SENTENCE) -> str:
    """Put free text on one line: no control characters, single spaces, capped."""
    shown = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return shown if len(shown) <= longest else shown[: longest - 1].rstrip() + "…"


def the_one_of(said: object, names: Iterable[str]) -> str | None:
    """Return the name that was meant, if letters and digits of exactly one are those that were said, or None."""
    if isinstance(said, float) and said.is_integer():
        said = int(said)
    if not isinstance(said, str | int) or isinstance(said, bool):
        return None
    known, text = dict.fromkeys(names), str(said).strip()
    if text in known:
        return text
    plain = _plain(text)
    fitting = [name for name in known if plain and _plain(name) == plain]
    return fitting[0] if len(fitting) == 1 else None


@lru_cache(maxsize=4096)
def _plain(text: str) -> str:
    return "".join(c for c in unicodedata.normalize("NFKC", text).casefold() if c.isalnum())


class Names:
    """What vehicles are called in a prompt.

    A plain id stays as it is. Whatever else an id holds, blanks and line breaks included, becomes ``_``. A vehicle of
    which the CAV cannot tell who drives is called ``V1``, ``V2``, ..., since an id like ``HDV1`` would give that away.
    """

    def __init__(self, known: Iterable[str], unknown: Iterable[str] = ()) -> None:
        self._shown: dict[str, str] = {}
        for name in dict.fromkeys(known):
            self._add(name, re.sub(r"[^\w.-]", "_", name, flags=re.ASCII)[:LONGEST_NAME] or "_")
        for k, name in enumerate(name for name in dict.fromkeys(unknown) if name not in self._shown):
            self._add(name, f"V{k + 1}")
        words = "|".join(re.escape(name) for name in sorted(self._shown, key=len, reverse=True))
        self._ids = re.compile(rf"(?<!\w)(?:{words})(?!\w)") if words else None

    def _add(self, name: str, shown: str) -> None:
        taken, count, free = set(self._shown.values()), 1, shown
        while free in taken:
            count += 1
            free = f"{shown}-{count}"
        self._shown[name] = free

    def __call__(self, name: str) -> str:
        """Return what a vehicle is called."""
        return self._shown.get(name, "V0")

    def sentence(self, text: str, longest: int = LONGEST_SENTENCE) -> str:
        """Put a sentence on one line, with every id replaced by what the vehicle is called."""
        if self._ids is not None:
            text = self._ids.sub(lambda found: self(found.group()), text)
        return one_line(text, longest)


def names_for(situation: Situation) -> Names:
    """Return what vehicles are called when one CAV is told of them."""
    scene = situation.scene
    kinds: Mapping[str, str | None] = {n.id: n.kind for n in scene.neighbours}
    known = [scene.ego.id, *(name for name, kind in kinds.items() if kind is not None)]
    ordered = [name for p in situation.order.precedences for name in (p.first, p.second)]
    return Names(known, [*(name for name, kind in kinds.items() if kind is None), *ordered])


def seen_names(scene: SceneDescription) -> Names:
    """Return what vehicles are called, by distance; ids would tell which are CAVs."""
    return Names([scene.ego.id], [n.id for n in scene.by_distance()])
