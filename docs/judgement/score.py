"""Scores judges of human drivers on the judged moments, and prints the tables of docs/judgement.md.

    python docs/judgement/score.py
    python docs/judgement/score.py rules_noted "llm llm=custom llm.model=openai/NAME llm.api_base=http://HOST/v1"

takes what is to be scored, each as the value of ``judgement=`` with further settings behind it; nothing for those that
need neither a model nor a memory. ``--file`` takes other moments.
"""

import argparse
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from codriving.config import compose
from codriving.exam.judges import Rate, Said, ask_judge, is_open, is_relied_on, rate, roads_of, squared
from codriving.exam.moments import WORLDS, JudgedMoment, read_moments

OURS = Path(__file__).parent / "moments.jsonl.xz"

USUAL = (
    "rules_noted",
    "earliest",
    "earliest judgement.against_priority=true",
    "learned",
    "learned judgement.yields_above=0.5 judgement.goes_below=0.5",
    "never",
    "always",
    "oracle",
)

Group = Callable[[JudgedMoment], str]

GROUPS: Mapping[str, Group] = {
    "world": lambda one: one.world,
    "style of the driver": lambda one: one.style,
    "who has priority": lambda one: {1: "the CAV", 0: "neither", -1: "the driver"}[
        int(one.contest.numbers["priority"])
    ],
    "who would be first": lambda one: _ahead(one.contest.numbers["time_ahead"]),
}


def _ahead(seconds: float) -> str:
    return "the CAV by 1 s" if seconds > 1 else "the driver by 1 s" if seconds < -1 else "neither"


def percent(found: Rate) -> str:
    """Write a share with its interval."""
    ends = f" ({found.interval[0]:.0%} to {found.interval[1]:.0%})".replace("%", "") if found.interval else ""
    return f"{found.mean:.0%}".replace("%", "") + ends


def digits(found: Rate, sign: str = "") -> str:
    """Write a score with its interval."""
    ends = f" ({found.interval[0]:{sign}.3f} to {found.interval[1]:{sign}.3f})" if found.interval else ""
    return f"{found.mean:{sign}.3f}{ends}"


def scores(moments: Sequence[JudgedMoment], said: Mapping[str, Said], against: str) -> list[str]:
    """Make the table of all moments."""
    lines = [
        "| `judgement` | by the rules [%] | right [%] (95 %) | yields, but goes [%] | goes, but yields [%] "
        f"| Brier (95 %) | Brier against `{against}` (95 %) |",
        "|---|---|---|---|---|---|---|",
    ]
    base = said.get(against)
    for name, one in said.items():
        told = list(zip(moments, one.judgements, strict=True))
        relied = [is_relied_on(moment, judged) for moment, judged in told]
        errors = [squared(moment, judged) for moment, judged in told]
        difference = "-"
        if base is not None and one is not base:
            others = [squared(moment, judged) for moment, judged in zip(moments, base.judgements, strict=True)]
            difference = (
                "0"
                if errors == others
                else digits(rate(moments, [a - b for a, b in zip(errors, others, strict=True)]), "+")
            )
        lines.append(
            f"| {shown(name)} | {sum(map(is_open, one.judgements)) / len(moments):.0%} ".replace("%", "")
            + f"| {percent(rate(moments, [r is m.yields for r, m in zip(relied, moments, strict=True)]))} "
            + f"| {percent(rate(moments, [r and not m.yields for r, m in zip(relied, moments, strict=True)]))} "
            + f"| {percent(rate(moments, [m.yields and not r for r, m in zip(relied, moments, strict=True)]))} "
            + f"| {digits(rate(moments, errors))} | {difference} |"
        )
    return lines


def parted(moments: Sequence[JudgedMoment], said: Mapping[str, Said], what: str) -> list[str]:
    """Make a table with a row for each group of moments: which share is right [%], and the Brier score."""
    lines = [
        f"| {what} | moments | yield [%] | {' | '.join(map(shown, said))} |",
        "|---" * (len(said) + 3) + "|",
    ]
    for group in sorted(set(map(GROUPS[what], moments))):
        rows = [k for k, moment in enumerate(moments) if GROUPS[what](moment) == group]
        cells = []
        for one in said.values():
            told = [(moments[k], one.judgements[k]) for k in rows]
            right = sum(is_relied_on(moment, judged) is moment.yields for moment, judged in told) / len(rows)
            cells.append(f"{100 * right:.0f}, {sum(squared(*pair) for pair in told) / len(rows):.3f}")
        yielding = sum(moments[k].yields for k in rows) / len(rows)
        lines.append(f"| {group} | {len(rows)} | {100 * yielding:.0f} | {' | '.join(cells)} |")
    return lines


def shown(name: str) -> str:
    """Write a judge with its settings as code; where a memory or a server is, is left out."""
    judge, *settings = name.split()
    kept = [text.removeprefix("judgement.") for text in settings if text.startswith(("judgement.", "llm.model="))]
    return f"`{judge}`" + (f" with `{' '.join(kept)}`" if kept else "")


def main() -> None:
    """Ask all, and print."""
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("judges", nargs="*", default=USUAL)
    asked.add_argument("--file", type=Path, default=OURS)
    asked.add_argument("--against", default="learned", help="whose Brier score the others are compared with")
    given = asked.parse_args()
    stored = read_moments(given.file)
    moments, roads = stored.moments, roads_of(WORLDS, compose)
    configs = {
        name: compose(["method=codriving", f"judgement={name.split()[0]}", *name.split()[1:]]) for name in given.judges
    }
    said = {name: ask_judge(config, moments, roads) for name, config in configs.items()}
    episodes, share = len({one.seed for one in moments}), sum(one.yields for one in moments) / len(moments)
    met = [one for one in moments if one.came is not None]
    print(f"{stored.sha256[:12]}: {len(moments)} moments of {episodes} episodes, seeds {stored.about['seeds']}.")
    print(f"The driver lets the CAV pass in {share:.0%}; one who says that has a Brier of {share * (1 - share):.3f}.")
    print(f"As the rules drove, {sum(one.came is one.yields for one in met)} of {len(met)} drivers did the same.")
    print("\n".join(["", *scores(moments, said, given.against)]))
    for what in GROUPS:
        print("\n".join(["", f"Right [%] and Brier, by {what}:", "", *parted(moments, said, what)]))
    for name, one in said.items():
        if one.counts:
            print(f"\n{name}: {dict(sorted(one.counts.items()))}")


if __name__ == "__main__":
    main()
