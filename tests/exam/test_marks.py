"""Answers are counted as they were judged."""

from dataclasses import replace

from small_exam import actions_of, small_exam

from codriving.exam.marks import mark
from codriving.exam.sitting import Answered

EXAM = small_exam()


def answers(place: int) -> list[Answered]:
    """The action at one place of all that are allowed."""
    of = zip(EXAM.situations, actions_of(EXAM), strict=True)
    return [Answered(one, allowed[place], yields=(True,) * len(one.contests)) for one, allowed in of]


def test_best_worse_and_bad_actions() -> None:
    n = len(EXAM.situations)
    assert n > 2
    for place, safe, acceptable in ((0, n, n), (1, n, 0), (2, 0, 0)):
        counts = mark([answers(place)])
        assert (counts["situations"], counts["safe"], counts["acceptable"], counts["best"]) == (
            n, safe, acceptable, acceptable,
        )  # fmt: skip
    none = mark([[Answered(one) for one in EXAM.situations]])
    assert (none["situations"], none["safe"], none["acceptable"]) == (n, 0, 0)


def test_drivers_pairs_and_times() -> None:
    drivers = sum(len(one.contests) for one in EXAM.situations)
    assert drivers > 0
    wrong = [replace(one, yields=tuple(not y for y in one.yields)) for one in answers(0)]
    open_ = [replace(one, yields=(None,) * len(one.yields)) for one in answers(0)]
    assert [mark([a])["drivers_right"] for a in (answers(0), wrong, open_)] == [drivers, 0, 0]
    assert [mark([a])["drivers"] for a in (answers(0), wrong, open_)] == [drivers, drivers, 0]
    pairs = [one.pairs[0] for one in EXAM.negotiations]
    told = [
        [
            Answered(one, first={(p.one, p.other): getattr(p, who)})
            for one, p in zip(EXAM.negotiations, pairs, strict=True)
        ]
        for who in ("one", "other")
    ]
    assert [mark([a])["pairs_acceptable"] for a in told] == [len(pairs), 0]
    assert mark([told[0], told[0], told[1]])["same"] == len(pairs)
    assert mark([told[0], told[0], told[1]])["again"] == 2 * len(pairs)


def test_forms_and_repairs() -> None:
    call = {"form": "json_schema"}
    line = {"value": {"action": "IDLE"}, "mended": False, "shortened": 0, "calls": [call]}
    lines = [line, {**line, "calls": [call, call]}, {**line, "mended": True}, {**line, "value": None}]
    counts = mark([[replace(answers(0)[0], lines=(one,)) for one in lines]])
    assert (counts["asked"], counts["in_form"], counts["unusable"], counts["form json_schema"]) == (4, 1, 1, 4)
