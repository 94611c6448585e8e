"""What a decision step asks of a model, in tokens and calls, against the authors' code."""

import json
import os
import tempfile
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import codriving
from benchmarks.options import options
from benchmarks.served import served
from codriving.config.choices import choices
from codriving.llm.prompts.render import SETS

CAVS, EPISODES, FIRST_SEED = 4, 3, 10_000
AUTHORS_CALLS, AUTHORS_TOKENS = 5, 4400
"""Calls and prompt tokens of a decision step of the authors' code with four CAVs, all of them asked at every step."""
FRAME = 3
"""Tokens that surround a message."""


def tokenizer() -> Callable[[str], int]:
    """Return what counts the tokens of a text, with the tokens of GPT-4 (cl100k); LiteLLM brings their list along."""
    os.environ.setdefault("LITELLM_LOCAL_MODEL_COST_MAP", "True")
    import litellm
    import tiktoken

    os.environ.setdefault("TIKTOKEN_CACHE_DIR", str(Path(litellm.__file__).parent / "litellm_core_utils/tokenizers"))
    encoding = tiktoken.get_encoding("cl100k_base")
    return lambda text: len(encoding.encode(text, disallowed_special=()))


def summary(lines: Iterable[dict[str, Any]], decisions: int, tokens: Callable[[str], int]) -> dict[str, float]:
    """Sum up transcripts.

    Args:
        lines: Their lines.
        decisions: Decision steps of all episodes, asked or not.
        tokens: Counts the tokens of a text.

    Returns:
        Calls and prompt tokens a step, as shares of the authors' too; mean prompts of either kind, and the tokens of a
        step that asks for an order and for the decision of every CAV.
    """
    prompts: defaultdict[str, list[int]] = defaultdict(list)
    for line in lines:
        for call in line["calls"]:
            prompts[line["purpose"]].append(sum(FRAME + tokens(message["content"]) for message in call["messages"]))
    calls = sum(map(len, prompts.values())) / decisions
    total = sum(map(sum, prompts.values())) / decisions
    order, decision = (sum(prompts[kind]) / max(len(prompts[kind]), 1) for kind in ("negotiate", "decide"))
    return {
        "decisions": decisions,
        "calls": round(calls, 2),
        "calls_share": round(calls / AUTHORS_CALLS, 3),
        "tokens": round(total),
        "tokens_share": round(total / AUTHORS_TOKENS, 3),
        "order_tokens": round(order),
        "decision_tokens": round(decision),
        "full_step_tokens": round(order + CAVS * decision),
        "full_step_share": round((order + CAVS * decision) / AUTHORS_TOKENS, 3),
    }


def measure(scenario: str, tokens: Callable[[str], int], model: Sequence[str], episodes: int) -> dict[str, float]:
    """Drive whole episodes and read their transcripts.

    Args:
        scenario: Name of the scenario.
        tokens: Counts the tokens of a text.
        model: Settings of the model.
        episodes: How many.

    Returns:
        See ``summary``.
    """
    asked = [f"scenario={scenario}", f"scenario.cavs={CAVS}", f"seed={FIRST_SEED}", f"episodes={episodes}"]
    with tempfile.TemporaryDirectory() as output:
        folder = codriving.run(*asked, *model, f"output={output}", "run=asked").folder
        episodes = list(folder.glob("episodes/*/*"))
        decisions = sum(json.loads((path / "record.json").read_text())["decisions"] for path in episodes)
        texts = [file.read_text() for path in episodes if (file := path / "transcript.jsonl").exists()]
    return summary((json.loads(line) for text in texts for line in text.splitlines()), decisions, tokens)


def main(arguments: list[str]) -> None:
    """Measure and print.

    Args:
        arguments: ``--json`` prints JSON instead of a table.
    """
    wanted = options(arguments, EPISODES)
    tokens = tokenizer()
    with served(0.0) as model:
        found = {
            name: {
                scenario: measure(scenario, tokens, [*model, f"llm.prompts={name}"], wanted.episodes)
                for scenario in choices("scenario")
            }
            for name in SETS
        }
    if wanted.json:
        print(json.dumps({"model_questions": found}))
        return
    print(f"model_questions: asked in a decision step with {CAVS} CAVs; in brackets the share of what the authors ask")
    for name, row in ((f"{prompts} {name}", row) for prompts, rows in found.items() for name, row in rows.items()):
        print(
            f"  {name:24}{row['calls']:5.2f} calls ({row['calls_share']:4.0%}){row['tokens']:6} prompt tokens "
            f"({row['tokens_share']:4.0%}); an order{row['order_tokens']:5}, a decision{row['decision_tokens']:5}; "
            f"if all are asked{row['full_step_tokens']:6} ({row['full_step_share']:4.0%})"
        )
