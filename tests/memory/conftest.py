"""Makes the server of the language-model tests importable."""

import sys
from pathlib import Path

LLM = str(Path(__file__).parents[1] / "llm")
if LLM not in sys.path:
    sys.path.insert(0, LLM)
