"""Makes ``toy_drive`` importable here and, since the search path travels along, in worker processes."""

import sys
from pathlib import Path

HERE = str(Path(__file__).parent)
if HERE not in sys.path:
    sys.path.insert(0, HERE)
