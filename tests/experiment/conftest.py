"""Makes ``test_batch`` importable here, whose helpers other tests of this room use."""

import sys
from pathlib import Path

HERE = str(Path(__file__).parent)
if HERE not in sys.path:
    sys.path.insert(0, HERE)
